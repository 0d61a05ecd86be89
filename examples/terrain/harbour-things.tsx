<?xml version="1.0" encoding="UTF-8"?>
<tileset version="1.10" tiledversion="1.11.0" name="things" tilewidth="32" tileheight="32" tilecount="3" columns="3">
 <image source="harbour-things.png" width="96" height="32"/>
</tileset>

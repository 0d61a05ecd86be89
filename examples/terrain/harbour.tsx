<?xml version="1.0" encoding="UTF-8"?>
<tileset version="1.10" tiledversion="1.11.0" name="harbour" tilewidth="16" tileheight="16" tilecount="14" columns="7">
 <image source="harbour.png" width="112" height="32"/>
 <tile id="4" type="water"/>
 <tile id="6">
  <properties>
   <property name="height" type="int" value="4"/>
  </properties>
 </tile>
 <tile id="7">
  <properties>
   <property name="height" type="int" value="6"/>
  </properties>
 </tile>
 <tile id="9">
  <properties>
   <property name="height" type="int" value="2"/>
   <property name="tile" value="red"/>
  </properties>
 </tile>
 <tile id="12">
  <properties>
   <property name="height" type="int" value="2"/>
   <property name="tile" value="beige"/>
  </properties>
 </tile>
</tileset>

"""Selects objects in the running Inkscape, through the actions that it has on the session's message bus (1.2 and newer)."""

NAME, PLACE = "org.inkscape.Inkscape", "/org/inkscape/Inkscape"
# In milliseconds.
TIMEOUT = 3000


def select(identifier):
    """Selects the object with an id in the active document. Returns whether Inkscape could be told."""
    from gi.repository import Gio, GLib

    try:
        bus = Gio.bus_get_sync(Gio.BusType.SESSION, None)
        for action, arguments in (("select-clear", []), ("select-by-id", [GLib.Variant("s", identifier)])):
            # An Inkscape that is not running is not started.
            bus.call_sync(
                NAME,
                PLACE,
                "org.gtk.Actions",
                "Activate",
                GLib.Variant("(sava{sv})", (action, arguments, {})),
                None,
                Gio.DBusCallFlags.NO_AUTO_START,
                TIMEOUT,
                None,
            )
    except GLib.Error:
        return False
    return True

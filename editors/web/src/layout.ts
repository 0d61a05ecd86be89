// Whether the window is small: then the parts are a drawer, toolbars fold, and one chart is open at a time.

/** The same as in the style sheets. */
export const SMALL = matchMedia("(max-width: 760px), (max-height: 500px)");

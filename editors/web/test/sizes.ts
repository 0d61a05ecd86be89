// The sizes of window that the page is made for.

/** A phone, upright and lying, the panel of an editor, and a desktop. */
export const SIZES = [
  { name: "phone", viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 },
  { name: "panel", viewport: { width: 520, height: 760 } },
  { name: "lying phone", viewport: { width: 844, height: 390 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 },
  { name: "desktop", viewport: { width: 1400, height: 900 } },
] as const;

// Drawings of an icon set in the format of Iconify, which keeps all of them in one JSON file.

/** The drawing of one icon as a whole SVG file. */
export function drawing({ icons, width = 16, height = 16 }, key) {
  const { body, width: wide = width, height: high = height } = icons[key]
  return `<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" viewBox="0 0 ${wide} ${high}">${body}</svg>`
}

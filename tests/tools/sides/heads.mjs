// How much of a head is hair or a hat in a picture of it.

/** What belongs to a head besides the head itself, hair and hats. */
const FACE = /^(ears?|eyes?|left eye|right eye|nose|mouth|mask|fangs|strap)$/i
/** How far a colour may be from a paint, in each channel of 255, to be surely that paint. */
const SAME = 12
/** From this on a pixel belongs to the model, not to its border. */
const OPAQUE = 200

/** The colour of a node: white for a head with all that is on it, black for others. Parts without a name are what they hang on. */
export function inBlackAndWhite({ head, covers, names }) {
  const worn = Object.keys(names).filter((label) => covers.includes(names[label]))
  const isOfHead = (label) => label === head || worn.includes(label) || FACE.test(label)
  return (name, ancestors) => {
    const label = [...ancestors, name].reverse().find((label) => label in names)
    return label !== undefined && isOfHead(label) ? [1, 1, 1] : [0, 0, 0]
  }
}

function distance(one, other) {
  return Math.max(...one.map((value, channel) => Math.abs(value - other[channel])))
}

/** Whether a colour is that of hair or a hat, rather than another of the drawing. */
function isCover(colour, { covers, others }) {
  const to = (paints) => Math.min(...paints.map((paint) => distance(colour, paint)))
  const nearest = to(covers)
  return nearest <= SAME || nearest < to(others)
}

/**
 * Of the pixels of a head, the share with colours of hair and hats. `colours` is a picture in plain colours, `heads` the same in black
 * and white. Nothing of the head that is seen counts as nothing that is right.
 */
export function covered(colours, heads, paints) {
  let all = 0
  let right = 0
  for (let at = 0; at < heads.data.length; at += 4) {
    if (heads.data[at + 3] < OPAQUE || heads.data[at] < OPAQUE) continue
    all += 1
    right += isCover([...colours.data.subarray(at, at + 3)], paints) ? 1 : 0
  }
  return all === 0 ? 0 : right / all
}

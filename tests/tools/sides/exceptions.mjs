// What is known to be beyond the limits: for each figure limits of its own, so that it gets no worse, and why. An exception that is no
// longer needed is an error.

const HEAD_ALONE = 'it is a head alone, which is no figure: a ball as deep as wide'
const LOW = 'it is low, and its legs stick out at both sides of the trunk'
const FACING = 'nothing says that it is a profile: it has no head of its own, and an eye on the trunk does not count'

export const EXCEPTIONS = {
  'noto-girl': { wide: [0.2, 0.82], why: HEAD_ALONE },
  'noto-cook': { wide: [0.2, 0.63], why: 'its hat goes around a head that is as deep as a figure allows' },
  'noto-badger': { high: [0.2, 0.55], why: LOW },
  'fluent-dragon': { found: 'front', why: FACING },
  'noto-man-supervillain': { back: [0.68, 1], why: 'its hair is drawn over the forehead only, and its neck has no name, so that it belongs to the body' },
}

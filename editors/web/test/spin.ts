// Rotations for the fixture's arm, whose node lies on its side: from its drawn position, an eighth of a turn each.

const REST = Math.atan2(-0.70710677, 0.70710677);

export const SPIN = [0, 1, 2, 3, 4].map((eighths) => [0, 0, Math.sin(REST + (eighths * Math.PI) / 8), Math.cos(REST + (eighths * Math.PI) / 8)]);

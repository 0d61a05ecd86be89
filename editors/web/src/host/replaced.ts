/** Newer models have replaced one since the page read of it; the message with their address is on its way. */
export class Replaced extends Error {
  constructor() {
    super("the drawing was built again meanwhile; try once more");
  }
}

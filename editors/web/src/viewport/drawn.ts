// Tells when the graphics card has drawn what it was told: calls to it return at once, and software takes long.

/** How often to ask, in milliseconds. */
const POLL = 10;

/**
 * Calls `then` once everything is drawn that was asked for until now, with `true`, or after so many milliseconds with `false`. Returns what
 * gives up.
 */
export function whenDrawn(context: WebGL2RenderingContext, patience: number, then: (isDrawn: boolean) => void): () => void {
  const drawn = context.fenceSync(context.SYNC_GPU_COMMANDS_COMPLETE, 0);
  context.flush();
  const begun = performance.now();
  const ask = (): void => {
    // The context may be lost.
    const isDrawn = drawn !== null && context.getSyncParameter(drawn, context.SYNC_STATUS) === context.SIGNALED;
    if (!isDrawn && performance.now() - begun < patience) {
      timer = setTimeout(ask, POLL);
      return;
    }
    context.deleteSync(drawn);
    then(isDrawn);
  };
  let timer = setTimeout(ask, POLL);
  return () => {
    clearTimeout(timer);
    context.deleteSync(drawn);
  };
}

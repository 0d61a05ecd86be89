// What a stream brings, as a whole.

export class TooLarge extends Error {
  constructor() {
    super("it is too large");
  }
}

/** All bytes of a stream. Rejects as soon as there are more than `largest`: a few bytes can unpack to any number. */
export async function collect(stream: ReadableStream<Uint8Array<ArrayBuffer>>, largest: number): Promise<Uint8Array<ArrayBuffer>> {
  const pieces: Uint8Array<ArrayBuffer>[] = [];
  let length = 0;
  for (const reader = stream.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(pieces).arrayBuffer());
    length += value.length;
    if (length > largest) {
      await reader.cancel();
      throw new TooLarge();
    }
    pieces.push(value);
  }
}

// Writes a GLB by hand.

/** The file of a glTF whose only buffer is `bytes`. */
export function glb(json: Readonly<Record<string, unknown>>, bytes: Buffer): Buffer {
  const filled = (content: Buffer, to: string): Buffer => Buffer.concat([content, Buffer.alloc((4 - (content.length % 4)) % 4, to)]);
  const binary = filled(bytes, "\0");
  const text = filled(Buffer.from(JSON.stringify({ ...json, buffers: [{ byteLength: bytes.length }] })), " ");
  const word = (...words: number[]): Buffer => Buffer.from(Uint32Array.from(words).buffer);
  return Buffer.concat([Buffer.from("glTF"), word(2, 28 + text.length + binary.length, text.length), Buffer.from("JSON"), text, word(binary.length), Buffer.from("BIN\0"), binary]);
}

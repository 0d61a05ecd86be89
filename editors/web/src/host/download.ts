// Saving a file as browsers do.

export async function download(name: string, content: Blob): Promise<void> {
  const address = URL.createObjectURL(content);
  const link = document.createElement("a");
  link.href = address;
  link.download = name;
  link.click();
  // The browser reads the blob after the click; it has started within a minute.
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

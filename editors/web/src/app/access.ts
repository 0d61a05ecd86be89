// Files of the computer: what is opened, dropped and written. Browsers that let pages at files give handles, by which a file can be written and read again.

import type { ProjectFile } from "../host/worker/calls";
import { kindOf } from "./kinds";
import { unpacked } from "./packed";

export interface Opened extends ProjectFile {
  readonly handle: FileSystemFileHandle | null;
  readonly seen: number;
  /** What a drawing was called that was compressed. */
  readonly packedAs?: string;
  /** Why it cannot be opened, as a sentence. */
  readonly trouble?: string;
}

/** The part of the File System Access API that TypeScript does not know. */
interface Access {
  showOpenFilePicker?(options: { multiple: boolean }): Promise<readonly FileSystemFileHandle[]>;
  showSaveFilePicker?(options: { suggestedName: string; types: readonly { description: string; accept: Record<string, readonly string[]> }[] }): Promise<FileSystemFileHandle>;
}
interface Allowed {
  queryPermission?(options: { mode: "read" | "readwrite" }): Promise<PermissionState>;
  requestPermission?(options: { mode: "read" | "readwrite" }): Promise<PermissionState>;
}
interface Dropped {
  getAsFileSystemHandle?(): Promise<FileSystemHandle | null>;
}

const access = globalThis as unknown as Access;

const gaveUp = (error: unknown): boolean => error instanceof DOMException && error.name === "AbortError";

/** The largest file that is read, in bytes: the module has 4 GB for everything. */
const LIMIT = 256 << 20;

/** Reads a file as it is at the moment. */
export async function read(file: File, path: string, handle: FileSystemFileHandle | null): Promise<Opened> {
  if (file.size > LIMIT) throw new Error(`${path} is larger than ${LIMIT >> 20} MiB`);
  return { path, bytes: new Uint8Array(await file.arrayBuffer()), handle, seen: file.lastModified };
}

/** Reads a file that a person opens. */
const take = async (file: File, path: string, handle: FileSystemFileHandle | null): Promise<Opened> => unpacked(await read(file, path, handle));

/** Lets a person choose files; nothing if they give up. */
export async function choose(): Promise<readonly Opened[]> {
  if (!access.showOpenFilePicker) return chooseByInput();
  try {
    const handles = await access.showOpenFilePicker({ multiple: true });
    return await Promise.all(handles.map(async (handle) => take(await handle.getFile(), handle.name, handle)));
  } catch (error) {
    if (gaveUp(error)) return [];
    throw error;
  }
}

function chooseByInput(): Promise<readonly Opened[]> {
  const input = document.createElement("input");
  input.type = "file";
  // No `accept`: phones would not let files be chosen whose kind they do not know, such as motions.
  input.multiple = true;
  return new Promise((resolve, reject) => {
    input.addEventListener("cancel", () => resolve([]));
    input.addEventListener("change", () => Promise.all([...(input.files ?? [])].map((file) => take(file, file.name, null))).then(resolve, reject));
    input.click();
  });
}

/** All files that were dropped, also those in folders, by their paths from there. */
export async function dropped({ items, files }: DataTransfer): Promise<readonly Opened[]> {
  // What was dropped can be asked for now, and not later.
  const asked = [...items].filter(({ kind }) => kind === "file").map((item) => ({
    handle: (item as unknown as Dropped).getAsFileSystemHandle?.().catch(() => null) ?? Promise.resolve(null),
    entry: item.webkitGetAsEntry(),
    file: item.getAsFile(),
  }));
  if (asked.length === 0) return Promise.all([...files].map((file) => take(file, file.name, null)));
  const found = await Promise.all(
    asked.map(async ({ handle, entry, file }) => {
      const held = await handle;
      if (held) return inHandle(held, held.name);
      if (entry?.isDirectory) return inEntry(entry, entry.name);
      return file ? [await take(file, file.name, null)] : [];
    }),
  );
  return found.flat();
}

/** Of what is in a folder: what drawings need, and other folders. */
const isWanted = ({ name }: { readonly name: string }, isFile: boolean): boolean => !name.startsWith(".") && (!isFile || typeof kindOf(name) === "string");

async function inHandle(handle: FileSystemHandle, path: string): Promise<readonly Opened[]> {
  if (isFile(handle)) return [await take(await handle.getFile(), path, handle)];
  const all: (readonly Opened[])[] = [];
  for await (const one of (handle as unknown as { values(): AsyncIterable<FileSystemHandle> }).values()) {
    if (isWanted(one, one.kind === "file")) all.push(await inHandle(one, `${path}/${one.name}`));
  }
  return all.flat();
}

const isFile = (handle: FileSystemHandle): handle is FileSystemFileHandle => handle.kind === "file";

async function inEntry(entry: FileSystemEntry, path: string): Promise<readonly Opened[]> {
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    return [await take(file, path, null)];
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  const all: (readonly Opened[])[] = [];
  // It is read in pieces, until there is nothing more.
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all.flat();
    for (const one of some) if (isWanted(one, one.isFile)) all.push(await inEntry(one, `${path}/${one.name}`));
  }
}

/** Whether a file can be chosen to be written. */
export const canSaveAs = access.showSaveFilePicker !== undefined;

/** Lets a person choose where to write a drawing; null if they give up. */
export async function chooseTarget(name: string): Promise<FileSystemFileHandle | null> {
  try {
    return (await access.showSaveFilePicker?.({ suggestedName: name, types: [{ description: "Drawing", accept: { "image/svg+xml": [".svg"] } }] })) ?? null;
  } catch (error) {
    if (gaveUp(error)) return null;
    throw error;
  }
}

/** Whether a file may be read without asking; a person may have to be asked again after a reload. */
export async function mayRead(handle: FileSystemFileHandle): Promise<boolean> {
  const allowed = handle as unknown as Allowed;
  return (await allowed.queryPermission?.({ mode: "read" })) !== "prompt";
}

/** Asks a person, if need be, whether a file may be written. */
export async function mayWrite(handle: FileSystemFileHandle): Promise<boolean> {
  const allowed = handle as unknown as Allowed;
  return (await allowed.requestPermission?.({ mode: "readwrite" })) !== "denied";
}

/** Replaces a file, and returns its new time of modification. */
export async function write(handle: FileSystemFileHandle, bytes: Uint8Array<ArrayBuffer>): Promise<number> {
  // Written beside it and put in its place when it is closed.
  const file = await handle.createWritable();
  await file.write(bytes);
  await file.close();
  return (await handle.getFile()).lastModified;
}

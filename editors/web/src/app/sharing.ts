// Sharing a drawing by a link, and opening what others share.

import { fill, h } from "../dom";
import type { WorkerHost } from "../host/worker";
import { reason, type Files } from "./files";
import { listed, type Notices } from "./notices";
import { isShared, linkTo, LONGEST, sharedIn, type Shared } from "./share";

/** What can be taken instead of a link. */
export interface Instead {
  /** Saves a page that plays the model. */
  page(): void;
}

/** Takes a link out of the page's address, if it is one, before the page takes it for the name of a drawing; the drawing in it is null if there is none. */
export function takeLink(): Promise<Shared | null> | null {
  const { hash } = location;
  if (!isShared(hash)) return null;
  history.replaceState(null, "", location.pathname + location.search);
  return sharedIn(hash).catch(() => null);
}

export class Sharing {
  constructor(private readonly files: Files, private readonly host: WorkerHost, private readonly notices: Notices, private readonly place: HTMLElement, private readonly instead: Instead) {}

  /** Opens the drawing of a link beside those that are there. */
  open(shared: Shared | null): void {
    if (shared) this.files.shared(shared);
    else this.notices.say("shared", "There is no drawing in this link: it was cut off or changed on its way. Ask for the link again, or for the drawing as a file. Your own drawings are as they were.");
  }

  /** Shows a link to a drawing, or why there is none. */
  async show(path: string): Promise<void> {
    try {
      const links = await this.host.links(path);
      await this.host.settled(path);
      const kept = this.files.get(path);
      if (!kept) return;
      const name = path.replace(/^.*\//, "");
      const link = await linkTo(location.href, { name, bytes: kept.bytes });
      if (links.length > 0) this.refuse(path, `${name} links to ${listed(links)}, and a link holds the drawing alone.`);
      else if (link.length > LONGEST) this.refuse(path, `${name} is too large for a link: it takes ${link.length.toLocaleString("en")} letters, and links of more than ${LONGEST.toLocaleString("en")} are cut off on their way.`);
      else this.offer(name, link);
    } catch (error) {
      this.notices.say("shared", `There is no link: ${reason(error)}.`);
    }
  }

  private offer(name: string, link: string): void {
    const field = h("input", { class: "share-link", attributes: { type: "text", readonly: true, "aria-label": `Link to ${name}` } });
    field.value = link;
    const said = h("p", { class: "muted", attributes: { role: "status" } });
    const copy = async (): Promise<void> => {
      field.select();
      try {
        await navigator.clipboard.writeText(link);
        said.textContent = "Copied.";
      } catch {
        // Browsers have it in secure contexts alone, and may refuse it.
        said.textContent = "The browser did not let the page copy it. It is selected: copy it with Ctrl+C.";
      }
    };
    const local = /^(localhost|127\.0\.0\.1|\[::1\])$/.test(location.hostname);
    const words = `Who opens this link gets a copy of ${name} as it is now. The drawing itself is in the link: it is sent nowhere, and a link cannot be taken back.`;
    const more = local ? "This page is served by your own computer, so the link only works on it." : "";
    this.dialog(`Link to ${name}`, [h("p", {}, words), field, more !== "" && h("p", { class: "muted" }, more), said], [["Copy", () => void copy()], ...(canHandOn(link) ? [["Send…", () => void navigator.share({ title: name, url: link }).catch(() => {})] as const] : [])]);
    field.select();
  }

  private refuse(path: string, why: string): void {
    const close = this.dialog(why, [h("p", {}, why), h("p", {}, "Share a page that plays the model, or the file.")], [
      ["Save a page (HTML)", () => (close(), this.instead.page())],
      ["Save the drawing (SVG)", () => (close(), void this.files.copy(path))],
    ]);
  }

  /** Shows a dialog with buttons, the last of which closes it; what it returns closes it, too. */
  private dialog(label: string, content: readonly (Node | false)[], choices: readonly (readonly [label: string, press: () => void])[]): () => void {
    const dialog = h("dialog", { class: "ask", attributes: { "aria-label": label } });
    const buttons = [...choices, ["Close", () => dialog.close()] as const].map(([label, press]) => h("button", { class: "button choice", attributes: { type: "button" }, on: { click: press } }, label));
    fill(dialog, ...content, h("div", { class: "choices" }, ...buttons));
    dialog.addEventListener("close", () => dialog.remove());
    this.place.append(dialog);
    dialog.showModal();
    return () => dialog.close();
  }
}

/** Whether the system can hand a link on to its other programs. */
const canHandOn = (link: string): boolean => typeof navigator.canShare === "function" && navigator.canShare({ url: link });

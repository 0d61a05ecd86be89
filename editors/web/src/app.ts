// The page as a program of its own: okoshi runs in a worker, and the files are the person's own.

import { TextCursorInput } from "lucide";
import "./style/page.css";
import "./style/app.css";
import { listenToDrops } from "./app/drop";
import { FileBar } from "./app/file-bar";
import { Files, reason } from "./app/files";
import { Notices } from "./app/notices";
import { Ready } from "./app/ready";
import type { Shared } from "./app/share";
import { Sharing, takeLink } from "./app/sharing";
import { Store } from "./app/store";
import { Strings } from "./app/strings/panel";
import { Welcome } from "./app/welcome";
import { button, h } from "./dom";
import { WorkerHost, type WorkerEvents } from "./host/worker";
import { start } from "./page";

/** The worker's script and the player's page are beside this one. */
const folder = document.currentScript instanceof HTMLScriptElement ? document.currentScript.src : location.href;

async function begin(page: HTMLElement): Promise<void> {
  const notices = new Notices();
  const ready = new Ready(folder);
  const events: WorkerEvents = { text: (path, text) => files.text(path, text), fault: (fault) => files.fault(fault), slow: (slow) => (slow ? notices.say("slow", slow.words, [{ label: "Stop", press: slow.stop }]) : notices.take("slow")), filming: (stop) => (stop ? notices.say("film", "The moving picture is still being made. You can go on meanwhile.", [{ label: "Stop", press: stop }]) : notices.take("film")), share: (path) => void sharing.show(path) };
  const host = new WorkerHost(() => new Worker(new URL("worker.js", folder), { type: "module" }), events, new URL("player.html", folder), { starters: ready.starters, at: (file) => ready.at(file), begin: async (name) => files.shared(await ready.drawing(name)) });
  // Before the page looks at its address.
  const first = takeLink() ?? begun(ready);
  addEventListener("hashchange", (event) => {
    const link = takeLink() ?? begun(ready);
    if (!link) return;
    event.stopImmediatePropagation();
    void link.then((shared) => sharing.open(shared));
  });
  const { state, bar, exports, gallery, editing, side, edits } = start(page, host);
  const strings = new Strings(state, host, editing);
  const opener = button({ icon: TextCursorInput, label: "Strings", wide: true, class: "strings-opener", press: () => {} });
  edits.append(opener);
  side.add("Strings", strings.element, opener, (shown) => (strings.shown = shown));
  const files = new Files(host, state, notices, page);
  const sharing = new Sharing(files, host, notices, page, { page: () => void exports.page() });
  const loading = h("p", { class: "app-loading muted" }, "okoshi is being loaded…");
  const lessons = ready.made.lessons ? "lessons.html" : null;
  gallery.insert(new Welcome(state, ready, () => gallery.starters.begin(ready.first.name)).element);
  const drop = listenToDrops(
    (opened) => files.open(opened),
    (error) => notices.say("opened", `What was dropped could not be read: ${reason(error)}.`),
  );
  bar.append(new FileBar(files, state, notices, () => strings.flush(), lessons).element);
  page.append(loading, notices.element, drop);
  state.on(["drawings", "link"], () => (loading.hidden = state.known || state.link === "lost"));
  // Not before the module has come: what is kept for a next time would take its turn on the way. Without a secure address there is no such thing, and the
  // page works while its server is there.
  let isKept = !("serviceWorker" in navigator);
  state.on("link", () => {
    if (isKept || state.link === "connecting") return;
    isKept = true;
    navigator.serviceWorker.register("service-worker.js").catch((error: unknown) => console.warn(error));
  });
  files.restore(await Store.open(), first !== null);
  // What the browser kept is known now, and loses nothing.
  if (first) sharing.open(await first);
}

/** The drawing that the page's address asks for by name, as links of lessons do; null if it asks for none. */
function begun(ready: Ready): Promise<Shared | null> | null {
  const name = ready.takeName();
  return name === null ? null : ready.drawing(name).catch(() => null);
}

const page = document.getElementById("page");
if (page) void begin(page);

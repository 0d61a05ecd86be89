// Makes the page of lessons of docs/lessons.md, for the folder that is the program in a browser.

import { copyFileSync, existsSync, mkdirSync, readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { micromark } from "micromark";

const here = join(dirname(fileURLToPath(import.meta.url)), "..");
const docs = join(here, "..", "..", "docs");

/** Copies the pictures into a folder; returns the page, in which that is `FOLDER/`, and the drawings that it links to, by name. */
export function lessons(room) {
  const drawings = {};
  mkdirSync(join(room, "lessons"));
  const picture = (source) => {
    const name = source.replaceAll("/", "-");
    copyFileSync(join(docs, source), join(room, "lessons", name));
    return `FOLDER/lessons/${name}`;
  };
  /** The page's own address of what a link of the manual leads to; null for other pages of the manual, which are not in the folder. */
  const address = (link) => {
    if (link.startsWith("#") || link.startsWith("https://")) return link;
    const file = join(docs, link.replace(/#.*/, ""));
    if (!existsSync(file)) throw new Error(`docs/lessons.md links to ${link}, which does not exist`);
    if (!link.endsWith(".svg")) return null;
    // Several folders have a boy, and an example has the name of a drawing to start from.
    const name = link.replace(/^\.\.\/(src\/starters\/|examples\/(?=.*\/))?/, "").replace(/\.svg$/, "").replaceAll("/", "-");
    drawings[name] = file;
    return `./#begin=${name}`;
  };
  const slug = (heading) => heading.toLowerCase().replace(/<[^>]*>|[^\p{L}\p{N} -]/gu, "").replaceAll(" ", "-");
  const body = micromark(readFileSync(join(docs, "lessons.md"), "utf8"))
    .replace(/<img src="([^"]*)"/g, (_, source) => `<img src="${picture(source)}"`)
    .replace(/<a href="([^"]*)">(.*?)<\/a>/gs, (_, link, text) => {
      const to = address(link);
      return to === null ? text : `<a href="${to}"${to.startsWith("./") ? ' class="opens"' : ""}>${text}</a>`;
    })
    .replace(/<h([23])>(.*?)<\/h\1>/gs, (_, level, text) => `<h${level} id="${slug(text)}">${text}</h${level}>`)
    // Each lesson is a page when it is printed.
    .replace(/<h2 [\s\S]*?(?=<h2 |$)/g, (lesson) => `<section>\n${lesson}</section>\n`);
  copyFileSync(join(here, "src", "style", "lessons.css"), join(room, "lessons.css"));
  return { page: readFileSync(join(here, "src", "lessons.html"), "utf8").replace("LESSONS", () => body), drawings };
}

// Descriptions, which the program writes in Markdown, as elements. Nothing in them is parsed as markup.

import type { Nodes, Parents } from "mdast";
import { fromMarkdown } from "mdast-util-from-markdown";
import { h } from "../../dom";

/** It scrolls where there is little room, also by keys. */
export const described = (markdown: string): HTMLElement => h("div", { class: "described", attributes: { tabindex: 0 } }, ...inside(fromMarkdown(markdown)));

const inside = (node: Parents): (Node | string)[] => node.children.map(made);

function made(node: Nodes): Node | string {
  switch (node.type) {
    case "paragraph":
      return h("p", {}, ...inside(node));
    case "heading":
    case "strong":
      return h("strong", {}, ...inside(node));
    case "emphasis":
      return h("em", {}, ...inside(node));
    case "list":
      return h("ul", {}, ...inside(node));
    case "listItem":
      return h("li", {}, ...inside(node));
    case "blockquote":
      return h("blockquote", {}, ...inside(node));
    case "inlineCode":
      return h("code", {}, node.value);
    case "code":
      return h("pre", {}, h("code", {}, node.value));
    case "thematicBreak":
      return h("hr");
    case "break":
      return h("br");
    // Pages of the manual are not here, and a person cannot be led away from the drawing: the words stay.
    case "link":
      return h("span", {}, ...inside(node));
    default:
      return "value" in node ? node.value : "children" in node ? h("span", {}, ...inside(node)) : "";
  }
}

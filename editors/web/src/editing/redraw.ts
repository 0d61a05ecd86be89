// A form that is drawn again. The control that a person is in stays in the page if it shows the same: another one in its place would have no caret,
// no selection, and no word that an input method is still composing.

import { h, fill } from "../dom";

/** What stays together: the controls of one value, which know each other. */
const GROUP = ".argument, .form-row";

/** Puts the new content into a form. With `stays`, the control that has the focus may stay; its listeners must still do what those of the new one would. */
export function redraw(form: HTMLElement, stays: boolean, ...content: (Node | false | null)[]): void {
  const active = document.activeElement;
  if (!(active instanceof HTMLElement) || !form.contains(active) || active.dataset["key"] === undefined) return fill(form, ...content);
  const fresh = h("form");
  fill(fresh, ...content);
  const { key } = active.dataset;
  const again = [...fresh.querySelectorAll<HTMLElement>("[data-key]")].find((one) => one.dataset["key"] === key);
  const [old, next] = [active.closest(GROUP), again?.closest(GROUP)];
  if (stays && active instanceof HTMLInputElement && old && next && isSame(old, next) && isSamePath(old, form, next, fresh)) {
    takeOver(old, next);
    return fillAround(form, old, next);
  }
  const selection = active instanceof HTMLInputElement ? selectionOf(active) : null;
  fill(form, ...fresh.childNodes);
  again?.focus({ preventScroll: true });
  if (!(again instanceof HTMLInputElement) || !selection) return;
  if (selection === "all") again.select();
  else again.setSelectionRange(...selection);
}

/** What is selected of a text. Of a number no browser tells: all of it, since the caret's place in one number means nothing in another. */
function selectionOf(input: HTMLInputElement): "all" | [start: number, end: number] | null {
  if (input.type === "number") return "all";
  const { selectionStart: start, selectionEnd: end } = input;
  if (start === null || end === null) return null;
  return start === 0 && end === input.value.length && end > 0 ? "all" : [start, end];
}

/** Whether the controls of two groups are the same and show the same. */
function isSame(old: Element, next: Element): boolean {
  const [ones, others] = [[...old.children], [...next.children]];
  return ones.length === others.length && ones.every((one, at) => {
    const other = others[at]!;
    if (!(one instanceof HTMLInputElement) || !(other instanceof HTMLInputElement)) return one.tagName === other.tagName;
    return one.type === other.type && one.dataset["key"] === other.dataset["key"] && one.value === other.value;
  });
}

/** Whether both lie in elements of the same kinds. */
function isSamePath(old: Element, form: Element, next: Element, fresh: Element): boolean {
  for (let [one, other]: (Element | null)[] = [old, next]; one && other; [one, other] = [one.parentElement, other.parentElement]) {
    if (one === form || other === fresh) return one === form && other === fresh;
    if (one.tagName !== other.tagName) return false;
  }
  return false;
}

/** Gives the controls of a group that stays what is said of the new ones, such as their limits. */
function takeOver(old: Element, next: Element): void {
  const others = [...next.children];
  [...old.children].forEach((one, at) => {
    if (one instanceof HTMLInputElement) copyAttributes(one, others[at]!);
    else one.replaceWith(others[at]!);
  });
}

/** Replaces all that is around an element, up to the form. */
function fillAround(form: Element, stays: Element, next: Element): void {
  for (let [one, other] = [stays, next]; one !== form; ) {
    const [parent, from] = [one.parentElement!, other.parentElement!];
    for (const sibling of [...parent.childNodes]) if (sibling !== one) sibling.remove();
    const siblings = [...from.childNodes];
    const at = siblings.indexOf(other);
    one.before(...siblings.slice(0, at));
    one.after(...siblings.slice(at + 1));
    if (parent !== form) copyAttributes(parent, from);
    [one, other] = [parent, from];
  }
}

function copyAttributes(to: Element, from: Element): void {
  for (const { name } of [...to.attributes]) if (!from.hasAttribute(name)) to.removeAttribute(name);
  for (const { name, value } of from.attributes) if (to.getAttribute(name) !== value) to.setAttribute(name, value);
}

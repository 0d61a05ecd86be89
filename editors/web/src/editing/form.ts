// The form of the selected part: its name, its parent and its attributes. What is changed here is sent at once.

import { MousePointerClick, RotateCcw } from "lucide";
import { button, fill, h, icon, inCode } from "../dom";
import type { State } from "../state";
import { clipFields } from "./clips";
import { fieldControls, SETTLED, type Sending, type Trying } from "./controls";
import { fieldDraft } from "./draft";
import type { Editing } from "./editing";
import type { Change, Field, PartForm } from "./messages";
import { redraw } from "./redraw";
import { silent } from "./values";

/** Attributes that are shown without being asked for. */
const FIRST: readonly string[] = ["Color", "Shape", "Offset"];
const FROM: Readonly<Record<string, string>> = { own: "set here", legend: "from a legend", default: "from the drawing's defaults", builtin: "" };

export class FormPanel {
  readonly element = h("form", { class: "part-form", hidden: true, attributes: { "aria-label": "Change the selected part", autocomplete: "off" } });
  /** The form that is shown. */
  private form: PartForm | null = null;
  /** The form that was drawn last, if none of its controls was given up since. */
  private drawn: PartForm | null = null;
  /** Counts what was asked for: an answer that is late is dropped. */
  private asked = 0;
  /** The control in which something is being typed or dragged; then the form is not drawn again. */
  private held: HTMLInputElement | null = null;
  /** Whether the name gets the focus as soon as it is there. */
  private names = false;
  /** The attribute that gets it. */
  private goal = "";
  private late = false;
  /** The figure that gets one more clip, and how many it has. */
  private adds = "";
  /** Fields that a person opened. */
  private readonly opened = new Set<string>();

  /** Called with the form that is shown, or none; set by the page. */
  shown: (form: PartForm | null) => void = () => {};

  constructor(private readonly editing: Editing, private readonly state: State) {
    this.element.addEventListener("submit", (event) => event.preventDefault());
    this.element.addEventListener("input", ({ target }) => {
      if (target instanceof HTMLInputElement && target.type !== "checkbox") this.held = target;
    });
    this.element.addEventListener("change", () => this.release());
    this.element.addEventListener(SETTLED, () => this.release());
    // Only when the focus is where it goes can it stay there. It may have left a control whose place another one took, in which one types already.
    this.element.addEventListener("focusout", () => void setTimeout(() => {
      if (this.held === null || this.held !== document.activeElement) this.release();
    }));
    this.element.addEventListener("keydown", (event) => {
      const { target } = event;
      // What was typed, and not sent, is given up.
      if (event.key !== "Escape" || !(target instanceof HTMLInputElement) || this.held === null) return;
      event.preventDefault();
      this.held = null;
      this.drawn = null;
      forget(target);
      this.editing.giveUp();
      this.draw();
    });
    editing.listen(["mode"], () => this.load());
    // What was refused is shown as it is.
    editing.listen(["done"], () => {
      if (editing.refusal) this.load();
    });
    editing.listen(["picking"], () => this.draw());
    state.on(["selection", "current"], () => {
      this.held = null;
      this.names = false;
      this.goal = "";
      editing.giveUp();
      // Until its own form is there, nobody changes another part by mistake. Whoever is in the form has renamed the part.
      const isOther = this.form !== null && this.form.part !== state.selected;
      this.element.inert = isOther && !this.element.contains(document.activeElement);
      this.load();
    });
    state.on("build", (drawing) => {
      if (drawing === state.current) this.load();
    });
  }

  /** Goes to the name of the part. */
  rename(): void {
    this.names = true;
    this.draw();
  }

  /** Goes to the first control of an attribute. */
  goTo(attribute: string): void {
    this.goal = attribute;
    this.draw();
  }

  /** Asks for the part that this one hangs on. */
  askParent(): void {
    const { selected } = this.state;
    if (selected === null) return;
    this.editing.pick((parent) => void this.editing.apply({ change: "hang", part: selected, parent }));
  }

  private release(): void {
    this.held = null;
    this.editing.giveUp();
    if (this.late) this.draw();
  }

  private load(): void {
    const asked = ++this.asked;
    const { selected } = this.state;
    if (!this.editing.isOn || selected === null) {
      this.form = null;
      this.shown(null);
      return this.draw();
    }
    this.element.setAttribute("aria-busy", "true");
    const { sent } = this.editing;
    void this.editing.form(selected).then((form) => {
      if (asked !== this.asked) return;
      // It says nothing of what was changed since it was asked for.
      if (sent !== this.editing.sent) return this.load();
      this.element.setAttribute("aria-busy", "false");
      this.form = form && this.form?.part === form.part ? goOn(this.form, form) : form;
      this.shown(this.form);
      this.draw();
    });
  }

  private draw(): void {
    if (this.held !== null) return void (this.late = true);
    this.late = false;
    const { form } = this;
    this.element.hidden = form === null;
    this.element.inert = form !== null && this.element.inert && form.part !== this.state.selected;
    this.element.dataset["formOf"] = form?.part ?? "";
    if (!form) return void fill(this.element);
    const isFirst = (field: Field): boolean => FIRST.includes(field.attribute);
    const rest = form.fields.filter((field) => !isFirst(field));
    const first = FIRST.flatMap((attribute) => form.fields.filter((field) => field.attribute === attribute));
    const carries = form.motion?.figure === form.part;
    redraw(
      this.element,
      this.drawn === form,
      ...(form.node ? [this.naming(form), this.parents(form)] : []),
      ...first.map((field) => this.field(form, field)),
      ...(carries ? this.clips(form) : []),
      ...(rest.length > 0 ? [h("h3", { class: "form-more" }, "More")] : []),
      !carries && this.foldedClips(form),
      ...rest.map((field) => this.folded(form, field)),
      form.node && this.leaving(form),
    );
    this.drawn = form;
    if (this.names && form.node && form.part === this.state.selected) {
      this.names = false;
      const name = this.element.querySelector<HTMLInputElement>("[data-key=name]");
      name?.focus();
      return name?.select();
    }
    if (this.goal !== "" && form.part === this.state.selected) {
      const field = this.element.querySelector<HTMLElement>(`[data-attribute="${this.goal}"]`);
      this.goal = "";
      if (field instanceof HTMLDetailsElement) field.open = true;
      field?.scrollIntoView({ block: "nearest" });
      field?.querySelector<HTMLElement>("input, select, [role=radio][tabindex='0']")?.focus({ preventScroll: true });
    }
  }

  private naming(form: PartForm): HTMLElement {
    const input = h("input", { class: "text-field", attributes: { type: "text", "aria-label": "Name", "data-key": "name", spellcheck: "false", autocomplete: "off", placeholder: form.named ? "" : `${form.part}: type a name` } });
    input.value = form.named ? form.part : "";
    input.addEventListener("change", () => this.call(form, input.value.trim()));
    return h("label", { class: "form-row" }, h("span", { class: "form-label" }, "Name"), input);
  }

  private call(form: PartForm, name: string): void {
    if (name === "" || (name === form.part && form.named)) return void this.draw();
    void this.editing.make(form, { change: "name", part: form.part, name });
  }

  private parents(form: PartForm): HTMLElement {
    const select = h("select", { class: "select", attributes: { "aria-label": "Hangs on", "data-key": "parent" } });
    const names = [...new Set([...form.parents, ...(form.parent === null ? [] : [form.parent])])];
    fill(select, h("option", { attributes: { value: "" } }, "nothing"), ...names.map((name) => h("option", { attributes: { value: `@${name}` } }, name)));
    select.value = form.parent === null ? "" : `@${form.parent}`;
    const hang = (parent: string | null): void => void this.editing.make(form, { change: "hang", part: form.part, parent });
    select.addEventListener("change", () => hang(select.value === "" ? null : select.value.slice(1)));
    const { isPicking } = this.editing;
    const pick = button({ icon: MousePointerClick, label: "Click what it hangs on", press: () => this.editing.pick(isPicking ? null : hang) });
    pick.setAttribute("aria-pressed", String(isPicking));
    pick.dataset["key"] = "pick";
    return h("div", { class: "form-row" }, h("span", { class: "form-label" }, "Hangs on"), select, pick);
  }

  private leaving(form: PartForm): HTMLElement {
    const leave = (): void => void this.editing.make(form, { change: "leave-out", part: form.part });
    return h("p", { class: "form-end" }, h("button", { class: "button framed", attributes: { type: "button", "data-key": "leave-out" }, on: { click: leave } }, "Leave this part out of the model"));
  }

  private field(form: PartForm, field: Field): HTMLElement {
    return h("section", { class: "field", attributes: { "data-attribute": field.attribute, "aria-label": field.attribute } }, h("div", { class: "field-head" }, h("h3", {}, field.attribute), ...this.origin(form, field)), ...this.inside(form, field));
  }

  /** A field that is opened when it is needed; one that is set here is open. */
  private folded(form: PartForm, field: Field): HTMLElement {
    const open = field.from === "own" || this.opened.has(field.attribute);
    const value = field.value === null ? "" : field.value || "on";
    const details = this.details(field.attribute, field.attribute, value || field.summary.replaceAll("`", ""), h("div", { class: "field-origin" }, ...this.origin(form, field)), ...this.inside(form, field));
    details.open = open;
    return details;
  }

  private details(key: string, name: string, value: string, ...inside: HTMLElement[]): HTMLDetailsElement {
    const details = h("details", { class: "field", attributes: { "data-attribute": key, open: this.opened.has(key) } });
    const summary = h("summary", { class: "field-head", attributes: { "data-key": key } }, h("span", { class: "field-name" }, name), h("span", { class: "field-value muted" }, value));
    details.addEventListener("toggle", () => {
      if (details.open) this.opened.add(key);
      else this.opened.delete(key);
    });
    fill(details, summary, ...inside);
    return details;
  }

  /** The clips of the part's figure. */
  private clips(form: PartForm): HTMLElement[] {
    if (!form.motion) return [];
    const key = `${form.motion.figure} ${form.motion.clips.length}`;
    return clipFields(form.part, form.motion, {
      make: (change) => void this.editing.make(form, change),
      attempt: (change) => this.editing.attempt(form, change),
      adds: this.adds === key,
      add: () => {
        this.adds = key;
        this.draw();
      },
    });
  }

  /** The same in the form of a part that hangs on others. */
  private foldedClips(form: PartForm): HTMLElement | null {
    if (!form.motion) return null;
    const { figure, clips } = form.motion;
    const value = clips.map(({ words }) => words || "the one that fits").join(", ");
    return this.details("Motion", `Motion of ${figure}`, value || "none", ...this.clips(form));
  }

  /** From where the value is, and what takes it back. */
  private origin(form: PartForm, field: Field): HTMLElement[] {
    const from = FROM[field.from] ?? field.from;
    const said = h("span", { class: "muted field-from", ...(field.string === null ? {} : { title: field.string }) }, from);
    if (field.from !== "own") return [said];
    const draft = fieldDraft(form, field);
    const reset = (): void => {
      draft.say(silent(draft.now()));
      void this.editing.make(form, { change: "reset", part: form.part, attribute: field.attribute });
    };
    const taking = h("button", { class: "button reset", title: `Take ${field.attribute} away: ${field.default}`, attributes: { type: "button", "aria-label": `Reset ${field.attribute}`, "data-key": `${field.attribute} reset` }, on: { click: reset } }, icon(RotateCcw), "Reset");
    return [said, taking];
  }

  private inside(form: PartForm, field: Field): HTMLElement[] {
    const set = (value: string): Change => ({ change: "set", part: form.part, attribute: field.attribute, value });
    const send: Sending = (value) => void this.editing.make(form, value === null ? { change: "reset", part: form.part, attribute: field.attribute } : set(value));
    const attempt: Trying = (value) => this.editing.attempt(form, set(value));
    const shared = field.shared.length > 0 ? [h("p", { class: "muted field-note" }, `Shared with ${named(field.shared)}.`)] : [];
    return [h("p", { class: "muted field-note" }, ...inCode(sentence(field.summary))), ...shared, ...fieldControls(fieldDraft(form, field), send, attempt)];
  }
}

/** A form with what the program says of it now. What is being typed goes on in the form of the same part, and its clips in those of the same figure. */
function goOn(form: PartForm, next: PartForm): PartForm {
  const motion = form.motion && next.motion ? Object.assign(form.motion, next.motion) : next.motion;
  return Object.assign(form, next, { motion });
}

/** Lets a control forget that it was typed in: browsers say so when it loses the focus or leaves the page, and it would be sent. */
function forget(control: HTMLInputElement): void {
  const stop = (event: Event): void => event.stopImmediatePropagation();
  addEventListener("change", stop, { capture: true });
  control.blur();
  removeEventListener("change", stop, { capture: true });
  control.focus({ preventScroll: true });
}

const sentence = (text: string): string => `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;

/** A list of names that is not longer than it can be read. */
function named(names: readonly string[]): string {
  const shown = names.slice(0, 6).map((name) => name.replaceAll("`", ""));
  const more = names.length - shown.length;
  return more > 0 ? `${shown.join(", ")} and ${more} more` : shown.join(", ");
}

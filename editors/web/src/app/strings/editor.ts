// The texts of a drawing in an editor, each on a line of its own: lines cannot be added, removed or joined.

import { acceptCompletion, autocompletion, closeCompletion, completionKeymap, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap } from "@codemirror/commands";
import { setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { Annotation, EditorState, Prec, RangeSetBuilder, StateEffect, StateField, type Transaction } from "@codemirror/state";
import { Decoration, drawSelection, EditorView, hoverTooltip, keymap, tooltips, type DecorationSet } from "@codemirror/view";
import { sentences, type Line, type Place, type Proposals } from "./asking";
import { described } from "./markdown";

/** What the editor asks for, by the number of a line and a place in it. */
export interface Asks {
  place(line: number, at: number): Promise<Place | null>;
  proposals(line: number, at: number, text: string): Promise<Proposals | null>;
  /** A person changed a text. */
  typed(): void;
  /** The cursor is elsewhere. */
  moved(): void;
  /** A person has finished a text for now. */
  finished(): void;
  undo(): void;
  redo(): void;
}

const fromOutside = Annotation.define<true>();
const setMarked = StateEffect.define<ReadonlySet<number>>();

/** The lines of the selected part. */
const marked = StateField.define<DecorationSet>({
  create: () => Decoration.none,
  update(lines, transaction) {
    for (const effect of transaction.effects) if (effect.is(setMarked)) return markedIn(transaction.state, effect.value);
    return lines.map(transaction.changes);
  },
  provide: (field) => EditorView.decorations.from(field),
});

const line = Decoration.line({ class: "cm-of-part" });

function markedIn(state: EditorState, lines: ReadonlySet<number>): DecorationSet {
  const builder = new RangeSetBuilder<Decoration>();
  for (let number = 0; number < state.doc.lines; number++) if (lines.has(number)) builder.add(state.doc.line(number + 1).from, state.doc.line(number + 1).from, line);
  return builder.finish();
}

/** Whether a change stays within lines. */
function isWithinLines({ changes, startState }: Transaction): boolean {
  let isWithin = true;
  changes.iterChanges((from, to, _from, _to, inserted) => {
    if (inserted.lines > 1 || startState.doc.lineAt(from).to < to) isWithin = false;
  });
  return isWithin;
}

/** Replaces what differs between two versions of a text that stands at a place: all but their common beginning and end. */
function difference(from: number, to: number, before: string, text: string): { from: number; to: number; insert: string } {
  const shorter = Math.min(before.length, text.length);
  let start = 0;
  while (start < shorter && before[start] === text[start]) start++;
  let end = 0;
  while (end < shorter - start && before[before.length - 1 - end] === text[text.length - 1 - end]) end++;
  return { from: from + start, to: to - end, insert: text.slice(start, text.length - end) };
}

const theme = EditorView.theme({
  "&": { height: "100%", fontSize: "13px", color: "var(--ink)", backgroundColor: "var(--panel)" },
  "&.cm-focused": { outline: "2px solid var(--accent)", outlineOffset: "-2px" },
  ".cm-scroller": { fontFamily: "var(--code)", lineHeight: "1.5", overflow: "auto" },
  ".cm-content": { padding: "4px 0", caretColor: "var(--ink)" },
  ".cm-line": { padding: "3px 12px", borderBottom: "1px solid var(--line)" },
  ".cm-of-part": { backgroundColor: "var(--chosen)", color: "var(--chosen-ink)" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": { background: "color-mix(in srgb, var(--accent) 30%, transparent)" },
  ".cm-lintRange": { backgroundImage: "none", textDecoration: "underline wavy var(--error) 1px", textUnderlineOffset: "3px" },
  ".cm-lintRange-warning": { textDecorationColor: "var(--warning)" },
  ".cm-lintRange-hint": { textDecorationColor: "var(--hint)" },
  ".cm-tooltip": { border: "1px solid var(--line)", borderRadius: "8px", backgroundColor: "var(--panel)", color: "var(--ink)", boxShadow: "var(--shadow)", maxWidth: "min(420px, calc(100vw - 16px))", overflow: "hidden" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul": { fontFamily: "var(--code)", maxHeight: "min(14em, 40vh)" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li": { padding: "5px 8px" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li[aria-selected]": { backgroundColor: "var(--chosen)", color: "var(--chosen-ink)" },
  ".cm-completionDetail": { color: "var(--quiet)", fontStyle: "normal" },
  ".cm-completionMatchedText": { textDecoration: "none", fontWeight: "700" },
  ".cm-diagnostic": { padding: "5px 10px", borderLeft: "3px solid var(--error)" },
  ".cm-diagnostic-warning": { borderLeftColor: "var(--warning)" },
  ".cm-diagnostic-hint": { borderLeftColor: "var(--hint)" },
  ".described": { padding: "4px 12px 8px", maxHeight: "40vh", overflow: "auto", fontSize: "13px" },
  ".described p, .described ul, .described pre": { margin: "6px 0 0", whiteSpace: "pre-wrap" },
  ".described ul": { paddingLeft: "1.3em" },
  ".described hr": { border: "0", borderTop: "1px solid var(--line)" },
});

export class Editor {
  /** Styles of the editor are adopted by a shadow root: the page's policy takes none from scripts. */
  readonly element = document.createElement("div");
  private readonly view: EditorView;

  constructor(private readonly asks: Asks) {
    this.element.className = "strings-editor";
    const root = this.element.attachShadow({ mode: "open" });
    const run = (act: () => void) => (): boolean => (act(), true);
    const keys = [
      { key: "Mod-z", run: run(() => asks.undo()) },
      { key: "Mod-y", run: run(() => asks.redo()) },
      { key: "Mod-Shift-z", run: run(() => asks.redo()) },
      { key: "Enter", run: (view: EditorView) => acceptCompletion(view) || (asks.finished(), true) },
      // Tab leaves the editor.
      { key: "Escape", run: closeCompletion },
    ];
    const state = EditorState.create({
      extensions: [
        Prec.highest(keymap.of(keys)),
        keymap.of([...completionKeymap, ...defaultKeymap]),
        EditorView.lineWrapping,
        drawSelection(),
        marked,
        theme,
        tooltips({ position: "fixed" }),
        autocompletion({ override: [(context) => this.complete(context)], icons: false, defaultKeymap: false }),
        // A finger covers what it points at: what a word means stands below the editor, too.
        matchMedia("(hover: hover)").matches ? hoverTooltip((view, at) => this.hover(view, at)) : [],
        EditorView.contentAttributes.of({ "aria-label": "Strings of the drawing, one a line", autocapitalize: "off", autocorrect: "off", spellcheck: "false" }),
        EditorView.clipboardInputFilter.of((text) => text.replace(/\s*[\r\n]+\s*/g, " ")),
        EditorState.transactionFilter.of((transaction) => (transaction.docChanged && transaction.annotation(fromOutside) === undefined && !isWithinLines(transaction) ? [] : transaction)),
        EditorView.updateListener.of(({ docChanged, selectionSet, transactions }) => {
          if (transactions.some((one) => one.annotation(fromOutside))) return;
          if (docChanged) asks.typed();
          if (docChanged || selectionSet) asks.moved();
        }),
        EditorView.domEventHandlers({ blur: () => asks.finished() }),
      ],
    });
    this.view = new EditorView({ state, root, parent: root });
  }

  get hasFocus(): boolean {
    return this.view.hasFocus;
  }

  focus(): void {
    this.view.focus();
  }

  /** The cursor: the number of its line, from 0, and its place in that. */
  get cursor(): { readonly line: number; readonly at: number } {
    const { head } = this.view.state.selection.main;
    const { number, from } = this.view.state.doc.lineAt(head);
    return { line: number - 1, at: head - from };
  }

  text(line: number): string {
    return this.view.state.doc.line(line + 1).text;
  }

  get count(): number {
    return this.view.state.doc.lines;
  }

  /** Takes the texts of the drawing. As long as there are as many as before, only what differs is replaced, so that the cursor and what is shown about a word stay. */
  show(texts: readonly string[]): void {
    const { doc, selection } = this.view.state;
    if (texts.length === doc.lines) {
      const changes = texts.flatMap((text, number) => {
        const { from, to, text: before } = doc.line(number + 1);
        return before === text ? [] : [difference(from, to, before, text)];
      });
      if (changes.length > 0) this.view.dispatch({ changes, annotations: fromOutside.of(true) });
      return;
    }
    const text = texts.join("\n");
    this.view.dispatch({ changes: { from: 0, to: doc.length, insert: text }, selection: { anchor: Math.min(selection.main.head, text.length) }, annotations: fromOutside.of(true) });
  }

  /** Marks what is wrong, in the lines that are as they are in the drawing. */
  mark(lines: readonly Line[]): void {
    const { doc } = this.view.state;
    const diagnostics = lines.flatMap(({ text, problems }, number): Diagnostic[] => {
      const { from, text: shown } = doc.line(number + 1);
      if (shown !== text) return [];
      return problems.map((problem) => ({ from: from + problem.from, to: from + problem.to, severity: problem.severity, message: sentences(problem.message, problem.help) }));
    });
    this.view.dispatch(setDiagnostics(this.view.state, diagnostics));
  }

  /** Marks the lines of the selected part. */
  select(lines: ReadonlySet<number>, goTo: boolean): void {
    const [first] = lines;
    const at = first === undefined || !goTo ? null : this.view.state.doc.line(first + 1).from;
    const effects: StateEffect<unknown>[] = [setMarked.of(lines)];
    if (at !== null) effects.push(EditorView.scrollIntoView(at, { y: "nearest" }));
    this.view.dispatch({ effects, ...(at === null ? {} : { selection: { anchor: at } }), annotations: fromOutside.of(true) });
  }

  private async complete({ state, pos, explicit }: CompletionContext): Promise<CompletionResult | null> {
    const { number, from, text } = state.doc.lineAt(pos);
    // Behind a space everything is possible: that is shown when it is asked for.
    if (!explicit && /^$|\s$/.test(text.slice(0, pos - from))) return null;
    const found = await this.asks.proposals(number - 1, pos - from, text);
    if (!found || found.options.length === 0) return null;
    const options = found.options.map(({ label, kind, detail, text }) => ({ label, type: kind, detail, apply: text }));
    return { from: from + found.from, to: from + found.to, options, filter: false };
  }

  private async hover(view: EditorView, at: number) {
    const { number, from, text } = view.state.doc.lineAt(at);
    const place = await this.asks.place(number - 1, at - from);
    if (!place?.hover || view.state.doc.lines < number || view.state.doc.line(number).text !== text) return null;
    const { hover } = place;
    return { pos: from + hover.from, end: from + hover.to, above: true, create: () => ({ dom: described(hover.markdown) }) };
  }
}

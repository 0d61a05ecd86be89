// The page in the panel: the one that `okoshi preview` serves, with leave for what it needs and nothing else.

export interface Addresses {
  readonly script: string;
  readonly style: string;
  /** Where the panel's own files come from, as `Webview.cspSource` has it. */
  readonly source: string;
  /** Given to the one script that may run. */
  readonly nonce: string;
}

/** The page, of its bundle's page.html. */
export function html(template: string, { script, style, source, nonce }: Addresses): string {
  const policy = [
    "default-src 'none'",
    `script-src 'nonce-${nonce}'`,
    `style-src ${source}`,
    // Textures within models are read from blobs.
    `img-src ${source} blob: data:`,
    "connect-src blob:",
    "base-uri 'none'",
    "form-action 'none'",
  ].join("; ");
  const put = (text: string, old: string, now: string): string => {
    const [before, after, ...more] = text.split(old);
    if (before === undefined || after === undefined || more.length > 0) throw new Error(`page.html has not one ${old}`);
    return before + now + after;
  };
  let page = put(template, '<meta charset="utf-8">', `<meta charset="utf-8">\n    <meta http-equiv="Content-Security-Policy" content="${policy}">`);
  page = put(page, 'href="page.css"', `href="${style}"`);
  return put(page, '<script src="page.js"', `<script nonce="${nonce}" src="${script}"`);
}

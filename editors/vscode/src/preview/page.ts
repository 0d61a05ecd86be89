// The page in the panel: the one that `okoshi preview` serves, with a strict content security policy.

export interface Addresses {
  readonly script: string;
  readonly style: string;
  /** The origin of the panel's files: `Webview.cspSource`. */
  readonly source: string;
  /** The nonce of the only script that may run. */
  readonly nonce: string;
}

/** Fills in the bundle's page.html. */
export function html(template: string, { script, style, source, nonce }: Addresses): string {
  const policy = [
    "default-src 'none'",
    `script-src 'nonce-${nonce}'`,
    `style-src ${source}`,
    // Textures of models are read from blobs.
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

"""What the preview's page changes: a copy of Inkscape's canvas. Inkscape alone writes the drawing's own file.

A drawing's folder in the cache contains that copy, and `base`, the canvas without the page's changes. What differs is still to be taken
into the open document. Whenever there is another canvas, because the person saves or calls the preview again, the changes are made in
that, too. `saved` is the drawing's file as it was when it said the same as the canvas, to see what another program changes there.
"""

import json
import os

from okoshi_cache import folder_of, held, read, remove, write_atomic

BASE, KEPT, SAVED, COPY_LOCK = "base", "kept.json", "saved", "copy.lock"


def changed(folder, copy):
    """The canvas without and with the changes of the page, or None if there are none."""
    base, new = read(os.path.join(folder, BASE)), read(copy)
    return None if base is None or new is None or base == new else (base, new)


def renew(folder, copy, canvas):
    """Makes another canvas the one that the copy is of; what the page has changed is changed in that, too.

    Changes that do not fit any more are kept as sentences. Raises `ValueError` for a canvas that is not well-formed.
    """
    with held(folder, COPY_LOCK):
        done = False
        while not done:
            page = changed(folder, copy)
            new, kept = canvas, []
            if page is not None:
                new, _, kept = merged(page, canvas)
            # The page may have written the copy meanwhile.
            done = page == changed(folder, copy)
        write_atomic(copy, new)
        write_atomic(os.path.join(folder, BASE), canvas)
        if kept:
            write_atomic(os.path.join(folder, KEPT), json.dumps(told_before(folder) + [list(one) for one in kept]).encode())


def take(folder, copy, canvas, root):
    """Makes the page's changes in the document `root`, whose SVG text is `canvas`. Returns what was changed, and what could not be."""
    # lxml is there wherever Inkscape's own modules are.
    from okoshi_strings import Told, merge, parse

    with held(folder, COPY_LOCK):
        before = [Told(*one) for one in told_before(folder)]
        page = changed(folder, copy)
        taken, kept = [], []
        if page is not None:
            new = merged(page, canvas)[0]
            taken, kept = merge(*map(parse, page), root)
            if changed(folder, copy) == page:
                write_atomic(copy, new)
                write_atomic(os.path.join(folder, BASE), new)
        remove(os.path.join(folder, KEPT))
    return taken, before + kept


def take_saved(folder, path, root):
    """Makes in the document what another program has changed in the drawing's file. Returns what was changed, and what could not be.

    If nobody knows how the file was when Inkscape read or wrote it, whatever it says is taken for a change.
    """
    from okoshi_strings import merge, merge_unsure, parse

    saved, before = read(path), remembered(folder)
    if saved is None or saved == before:
        return [], []
    try:
        found = merge_unsure(parse(saved), root) if before is None else merge(parse(before), parse(saved), root)
    except ValueError:
        # Packed, or being written.
        return [], []
    write_atomic(os.path.join(folder, SAVED), session() + saved)
    return found


def remember(drawing):
    """Keeps the drawing's file for `take_saved`, if it says the same as the canvas."""
    from okoshi_strings import merge_unsure, parse

    if drawing.original is None:
        return
    folder, saved = folder_of(drawing), read(drawing.original)
    os.makedirs(folder, mode=0o700, exist_ok=True)
    try:
        texts = saved, drawing.data
        if saved is None or any(any(merge_unsure(parse(one), parse(other))) for one, other in (texts, reversed(texts))):
            return
    except ValueError:
        return
    write_atomic(os.path.join(folder, SAVED), session() + saved)


def remembered(folder):
    """The file that was kept, or None. Another Inkscape has read the drawing anew."""
    kept = read(os.path.join(folder, SAVED))
    return kept[len(session()) :] if kept is not None and kept.startswith(session()) else None


def session():
    """Which Inkscape has called us, as the first line of a file."""
    return b"%d\n" % os.getppid()


def merged(page, canvas):
    """A canvas with the changes of the page, what was changed, and what could not be."""
    from okoshi_strings import merge, parse, write

    root = parse(canvas)
    taken, kept = merge(*map(parse, page), root)
    return write(root) if taken else canvas, taken, kept


def told_before(folder):
    """Sentences on changes that did not fit, which nobody has read yet."""
    try:
        return json.loads(read(os.path.join(folder, KEPT)) or b"[]")
    except ValueError:
        return []

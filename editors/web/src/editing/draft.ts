// What a form says once all that was sent is made. A change says all of an attribute, and the program needs a moment until its form has it: the
// next change goes on from what was said last, not from what the program knew before.

import type { ClipForm, Field, MotionForm, PartForm } from "./messages";

/** Something that is changed: as it was said last. */
export interface Draft<One> {
  now(): One;
  say(next: One): void;
}

/** A field of a part. */
export const fieldDraft = (form: PartForm, field: Field): Draft<Field> => ({
  now: () => form.fields.find(({ attribute }) => attribute === field.attribute) ?? field,
  say: (next) => (form.fields = form.fields.map((one) => (one.attribute === next.attribute ? next : one))),
});

/** A clip of a figure; the number after that of the last one is the new one's. */
export const clipDraft = (motion: MotionForm, at: number): Draft<ClipForm> => ({
  now: () => motion.clips[at] ?? motion.new,
  say: (next) => {
    if (at < motion.clips.length) motion.clips = motion.clips.map((one, index) => (index === at ? next : one));
    else motion.new = next;
  },
});

/** A part of what is changed. */
export const within = <All, Key extends keyof All>(draft: Draft<All>, key: Key): Draft<All[Key]> => ({
  now: () => draft.now()[key],
  say: (next) => draft.say({ ...draft.now(), [key]: next }),
});

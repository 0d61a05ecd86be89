// The count-in: three clicks, as a metronome gives them.

/** How many clicks. */
const CLICKS = 3;
/** The time between two clicks, in seconds. */
const PAUSE = 0.7;
/** The pitch of the clicks, and of the one at which the recording begins, in hertz. */
const PITCH = 880;
const LAST_PITCH = 1320;
/** How long a click is heard, in seconds. */
const LENGTH = 0.06;
const LOUDNESS = 0.3;

export class CountIn {
  private audio: AudioContext | null = null;
  private timers: ReturnType<typeof setTimeout>[] = [];

  /** Counts down: `counted` is called with the number at each click, and with 0 when the recording begins. */
  start(isHeard: boolean, counted: (left: number) => void): void {
    this.cancel();
    if (isHeard) this.click();
    for (let click = 0; click <= CLICKS; click++) this.timers.push(setTimeout(() => counted(CLICKS - click), 1000 * PAUSE * click));
  }

  cancel(): void {
    for (const timer of this.timers) clearTimeout(timer);
    this.timers = [];
    void this.audio?.close();
    this.audio = null;
  }

  /** Schedules all clicks by the clock of the sound, which timers do not delay. */
  private click(): void {
    const audio = new AudioContext();
    this.audio = audio;
    const start = audio.currentTime + 0.02;
    for (let click = 0; click <= CLICKS; click++) {
      const at = start + PAUSE * click;
      const tone = new OscillatorNode(audio, { frequency: click === CLICKS ? LAST_PITCH : PITCH });
      const volume = new GainNode(audio, { gain: 0 });
      volume.gain.setValueAtTime(LOUDNESS, at);
      volume.gain.exponentialRampToValueAtTime(0.001, at + LENGTH);
      tone.connect(volume).connect(audio.destination);
      tone.start(at);
      tone.stop(at + LENGTH);
    }
  }
}

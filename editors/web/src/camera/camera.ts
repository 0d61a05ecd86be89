// The camera: small pictures with the times at which they were taken.

import type { Pixels } from "./messages";

/** The longest side of the pictures that are tracked, in pixels. */
const MAX_SIDE = 320;
/** The least time between two pictures in milliseconds: 30 pictures a second, of cameras that give more. */
const INTERVAL = 1000 / 30 - 5;

const WANTED: MediaStreamConstraints = { audio: false, video: { width: { ideal: 640, max: 1920 }, height: { ideal: 480, max: 1080 }, frameRate: { ideal: 30 } } };

export class Camera {
  /** The newest picture. */
  readonly canvas: HTMLCanvasElement;
  private readonly context: CanvasRenderingContext2D | null;
  private readonly video = document.createElement("video");
  private stream: MediaStream | null = null;
  private isHeld = false;
  /** When the newest picture was taken, in milliseconds; 0 before the first. */
  time = 0;

  /** `taken` is called for each new picture, `ended` when the camera is gone. */
  constructor(canvas: HTMLCanvasElement, private readonly taken: () => void, private readonly ended: () => void) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d", { willReadFrequently: true, alpha: false });
    this.video.muted = true;
    this.video.playsInline = true;
  }

  /** Asks for the camera and starts it; fails with what `whyNot` explains. */
  async start(): Promise<void> {
    if (!navigator.mediaDevices?.getUserMedia) throw new Error("insecure");
    const stream = await navigator.mediaDevices.getUserMedia(WANTED);
    this.stop();
    this.stream = stream;
    for (const track of stream.getVideoTracks()) track.addEventListener("ended", () => this.stream === stream && this.ended());
    this.video.srcObject = stream;
    await this.video.play();
    this.wait(stream);
  }

  stop(): void {
    for (const track of this.stream?.getTracks() ?? []) track.stop();
    this.stream = null;
    this.video.srcObject = null;
    this.isHeld = false;
    this.time = 0;
  }

  /** Holds the newest picture still, or goes on. */
  hold(isHeld: boolean): void {
    this.isHeld = isHeld;
  }

  /** Switches the camera off for a while, or on again. */
  pause(isPaused: boolean): void {
    this.isHeld = isPaused;
    for (const track of this.stream?.getVideoTracks() ?? []) track.enabled = !isPaused;
  }

  /** The newest picture. */
  pixels(): Pixels | null {
    return this.time > 0 && this.context ? this.context.getImageData(0, 0, this.canvas.width, this.canvas.height) : null;
  }

  private wait(stream: MediaStream): void {
    const again = (now: number, metadata?: VideoFrameCallbackMetadata): void => {
      if (this.stream !== stream) return;
      this.take(metadata?.captureTime ?? now);
      this.wait(stream);
    };
    if ("requestVideoFrameCallback" in this.video) this.video.requestVideoFrameCallback(again);
    else requestAnimationFrame(again);
  }

  private take(time: number): void {
    if (this.isHeld || time < this.time + INTERVAL || this.video.videoWidth === 0) return;
    const { videoWidth, videoHeight } = this.video;
    const { width, height } = smallSize(videoWidth, videoHeight);
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.context?.drawImage(this.video, 0, 0, width, height);
    this.time = time;
    this.taken();
  }
}

/** The size of the pictures that are tracked, for a camera's size. */
export function smallSize(width: number, height: number): { width: number; height: number } {
  const scale = Math.min(MAX_SIDE / Math.max(width, height), 1);
  return { width: Math.max(Math.round(width * scale), 1), height: Math.max(Math.round(height * scale), 1) };
}

/** Why there is no camera, and what to do. */
export function whyNot(error: unknown): string {
  const name = error instanceof Error ? error.name : "";
  if (error instanceof Error && error.message === "insecure") return "The browser gives cameras only to secure pages. Open the preview at the address that okoshi prints, on this machine.";
  switch (name) {
    case "NotAllowedError":
    case "SecurityError":
      return "The browser was not allowed to use the camera. Allow it for this page, beside the address, and try again.";
    case "NotFoundError":
    case "OverconstrainedError":
      return "There is no camera. Connect one and try again.";
    case "NotReadableError":
    case "AbortError":
      return "The camera cannot be used. Another program may be using it: close that one and try again.";
    default:
      return "The camera could not be started. Try again, or use another browser.";
  }
}

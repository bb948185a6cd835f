// A film of one playing of the run, recorded by the browser itself.
carom.makeFilm = (picture, clock) => {
  const KINDS = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];
  const RATE = 30; // frames in a second, at the most
  const BITS = 12e6; // in a second: edges of cells stay sharp
  const STILL = 500; // milliseconds that the last frame stays
  const kind = typeof MediaRecorder === "undefined" || !HTMLCanvasElement.prototype.captureStream
    ? undefined
    : KINDS.find((name) => MediaRecorder.isTypeSupported(name));

  let recorder = null;
  let canvas = null;
  clock.onChange(() => {
    if (!recorder) return;
    picture.draw(canvas);
    if (!clock.playing) finish();
  });
  function finish() {
    const ending = recorder;
    recorder = null; // what comes from now on is no part of it
    setTimeout(() => ending.stop(), STILL);
  }

  // Plays from the start at the speed that is chosen, to the end or a pause; then saves.
  function record(button) {
    if (recorder) {
      clock.pause();
      return;
    }
    clock.pause();
    clock.goTo(0);
    canvas = picture.draw();
    const chunks = [];
    const made = new MediaRecorder(canvas.captureStream(RATE), { mimeType: kind, videoBitsPerSecond: BITS });
    made.addEventListener("dataavailable", ({ data }) => { if (data.size) chunks.push(data); });
    made.addEventListener("stop", () => {
      button.removeAttribute("aria-busy");
      button.disabled = false;
      const [type] = kind.split(";");
      carom.save.file(new Blob(chunks, { type }), "film", type.split("/")[1]);
    });
    button.setAttribute("aria-busy", "true");
    made.start(1000);
    recorder = made;
    clock.play();
  }
  return { canRecord: Boolean(kind) && clock.last > 0, record };
};

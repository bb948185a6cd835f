// Spectrograms: where time is in them, and a click that goes there.
carom.makeSpectrograms = (clock) => {
  for (const drawing of document.querySelectorAll(".spectrogram")) {
    const [from, to] = [Number(drawing.dataset.from), Number(drawing.dataset.to)];
    const track = drawing.querySelector(".track");
    const marker = carom.format.create("div", { className: "now" });
    const ends = carom.format.create("p", { className: "hint ends" });
    ends.append(...[from, to].map((time) => carom.format.create("span", { textContent: carom.format.time(time, 4) })));
    track.append(marker);
    drawing.append(ends);
    track.addEventListener("click", (event) => {
      const area = track.getBoundingClientRect();
      clock.pause();
      clock.seek(from + ((event.clientX - area.left) / area.width) * (to - from));
    });
    const mark = () => {
      marker.style.left = `${(100 * (clock.time - from)) / (to - from)}%`;
      marker.dataset.time = String(clock.time);
    };
    clock.onChange(mark);
    mark();
  }
};

// The scene with what it takes to read it: title, time, and the colours with their values.
carom.makePicture = (scene, maps, clock) => {
  const { create, number } = carom.format;
  const title = document.querySelector("h1").textContent;
  const TICKS = 5;
  const even = (pixels) => 2 * Math.ceil(pixels / 2); // films want it

  // Draws onto a canvas; of a size in pixels, or as the scene is on the screen.
  function draw(canvas = create("canvas"), size = null) {
    const shot = scene.shot(size);
    const unit = shot.width / 60; // of all lengths
    const font = (share, weight = "") => `${weight} ${share * unit}px system-ui, "DejaVu Sans", sans-serif`;
    const [head, foot] = [3 * unit, 5 * unit];
    const [width, height] = [even(shot.width), even(shot.height + head + foot)];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    const context = canvas.getContext("2d");
    const { colour } = carom.theme;
    context.fillStyle = colour("card");
    context.fillRect(0, 0, width, height);
    context.fillStyle = colour("shade");
    context.fillRect(0, head, width, shot.height);
    context.drawImage(shot, 0, head);

    context.textBaseline = "middle";
    context.fillStyle = colour("ink");
    const time = `t = ${carom.format.time(clock.time, 5)}`;
    context.font = font(1.2);
    const taken = context.measureText(time).width + 3 * unit;
    context.textAlign = "right";
    context.fillText(time, width - unit, head / 2);
    context.textAlign = "left";
    context.font = font(1.3, "600");
    context.fillText(title, unit, head / 2, width - taken);

    const { field } = scene.state;
    const limits = scene.limits();
    const bar = { left: unit, top: head + shot.height + 2.2 * unit, width: width - 2 * unit, height: 0.9 * unit };
    context.font = font(1.05, "600");
    context.fillText(field.unit ? `${field.title} [${field.unit}]` : field.title, bar.left, bar.top - 1.1 * unit);
    const strip = create("canvas", { width: 256, height: 1 });
    const { bytes } = maps[field.map];
    strip.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(bytes), 256, 1), 0, 0);
    context.drawImage(strip, bar.left, bar.top, bar.width, bar.height);
    context.font = font(1);
    context.fillStyle = colour("faint");
    for (let k = 0; k < TICKS; k++) {
      const share = k / (TICKS - 1);
      context.textAlign = k === 0 ? "left" : k === TICKS - 1 ? "right" : "center";
      const value = number(limits.low + share * (limits.high - limits.low), 3);
      context.fillText(value, bar.left + share * bar.width, bar.top + 1.8 * unit);
    }
    return canvas;
  }
  return { draw };
};

// The one time that scene, curves and slider show: a tick of a list of ascending times.
carom.makeClock = (times) => {
  const listeners = [];
  const last = times.length - 1;
  const span = times[last] - times[0];
  const WHOLE_RUN = 12; // seconds that the whole run takes at speed 1
  let index = 0;
  let playing = false;
  let speed = 1;
  let time = times[0]; // while playing, between ticks
  let before = 0;

  function nearest(wanted) {
    let low = 0;
    let high = last;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= wanted) low = middle; else high = middle;
    }
    return wanted - times[low] <= times[high] - wanted ? low : high;
  }
  function tell() {
    for (const listener of listeners) listener(clock);
  }
  function goTo(wanted) {
    index = Math.min(last, Math.max(0, wanted));
    time = times[index];
    tell();
  }
  function advance(now) {
    if (!playing) return;
    time += Math.min(0.25, (now - before) / 1000) * clock.pace();
    before = now;
    if (time >= times[last]) {
      playing = false;
      index = last;
      tell();
      return;
    }
    const reached = nearest(time);
    if (reached !== index) {
      index = reached;
      tell();
    }
    requestAnimationFrame(advance);
  }

  const clock = {
    times,
    last,
    get index() { return index; },
    get time() { return times[index]; },
    get playing() { return playing; },
    pace: () => (speed * span) / WHOLE_RUN, // seconds of the run in a second
    goTo,
    step: (count) => goTo(index + count),
    seek: (wanted) => goTo(nearest(wanted)),
    setSpeed(wanted) {
      speed = wanted;
      tell();
    },
    play() {
      if (last === 0) return;
      if (index === last) index = 0;
      time = times[index];
      playing = true;
      before = performance.now();
      tell();
      requestAnimationFrame(advance);
    },
    pause() {
      playing = false;
      tell();
    },
    toggle: () => (playing ? clock.pause() : clock.play()),
    onChange: (listener) => listeners.push(listener),
  };
  return clock;
};

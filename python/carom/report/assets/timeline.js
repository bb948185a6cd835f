// Who touches whom and when: a row for each pair, stronger where the force was larger.
carom.makeTimeline = (parent, contacts, end, clock, charts, gutter) => {
  const { create, quantity, time } = carom.format;
  const rows = new Map();
  const strongest = Math.max(...contacts.map((contact) => contact.peak_force ?? 0));
  const panel = create("div", { className: "panel timeline", id: "timeline" });
  const events = [];
  const markers = [];
  panel.append(create("h2", { textContent: "Contacts" }));

  for (const contact of contacts) {
    const pair = contact.pair.join(" – ");
    if (!rows.has(pair)) {
      const name = create("span", { className: "name", textContent: pair, title: pair });
      name.style.width = `${gutter}px`;
      const track = create("div", { className: "track" });
      const marker = create("div", { className: "now" });
      markers.push(marker);
      track.append(marker);
      track.addEventListener("click", (event) => {
        const area = track.getBoundingClientRect();
        clock.pause();
        clock.seek(low + ((event.clientX - area.left) / area.width) * (high - low));
      });
      panel.append(create("div", { className: "row" }, name, track));
      rows.set(pair, track);
    }
    const release = contact.release ?? end;
    const middle = (contact.onset + release) / 2;
    const text = `${pair}: ${time(contact.onset, 5)} to ${contact.release === null ? "the end" : time(release, 5)}, `
      + `peak ${quantity(contact.peak_force, "N", 4)}, friction ${quantity(contact.friction_work, "J", 4)}`;
    const button = create("button", { type: "button", className: "event", title: text });
    button.setAttribute("aria-label", text);
    button.style.setProperty("--force", String(strongest ? contact.peak_force / strongest : 1));
    button.addEventListener("click", (event) => {
      event.stopPropagation();
      clock.pause();
      clock.seek(middle);
    });
    rows.get(pair).append(button);
    events.push({ button, onset: contact.onset, release });
  }
  parent.append(panel);

  let low = clock.times[0];
  let high = Math.max(clock.times[clock.last], low + Number.MIN_VALUE);
  const percent = (time) => (100 * (time - low)) / (high - low);
  function mark() {
    for (const marker of markers) {
      marker.style.left = `${percent(clock.time)}%`;
      marker.dataset.time = String(clock.time);
    }
  }
  function place() {
    for (const { button, onset, release } of events) {
      button.style.left = `${percent(onset)}%`;
      button.style.width = `${percent(release) - percent(onset)}%`;
      button.hidden = release < low || onset > high;
    }
    mark();
  }
  charts.onZoom((from, to) => {
    [low, high] = [from, to];
    place();
  });
  clock.onChange(mark);
  place();
};

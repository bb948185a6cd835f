// On paper there are drawings in place of what the screen shows: nothing blank, nothing cut.
carom.makePrinting = (picture, charts) => {
  const SCENE = { width: 1500, height: 900 };
  const holder = document.getElementById("printed-scene");
  let ready = false;

  function prepare() {
    if (ready) return;
    ready = true;
    carom.theme.lighten(true); // paper is white
    if (picture) holder.replaceChildren(picture.draw(undefined, SCENE));
    for (const chart of charts()) chart.printed.replaceChildren(carom.drawing.element(chart.svg()));
  }
  function restore() {
    if (!ready) return;
    ready = false;
    carom.theme.lighten(false);
    holder.replaceChildren();
    for (const chart of charts()) chart.printed.replaceChildren();
  }
  addEventListener("beforeprint", prepare);
  addEventListener("afterprint", restore);
  matchMedia("print").addEventListener("change", ({ matches }) => (matches ? prepare() : restore()));
};

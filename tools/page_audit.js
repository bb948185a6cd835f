// What is wrong with a page, as sentences; the least contrast of text with its ground is given.
(least) => {
  const wrong = [];
  const short = (element) => element.outerHTML.replace(/\s+/g, " ").slice(0, 90);
  const isShown = (element) => element.checkVisibility({ checkOpacity: true, checkVisibilityCSS: true });

  // Names: what a screen reader says of it.
  function nameOf(element) {
    const labels = [...(element.labels ?? [])].map((label) => label.textContent);
    const named = (element.getAttribute("aria-labelledby") ?? "").split(" ").filter(Boolean)
      .map((id) => document.getElementById(id)?.textContent ?? "");
    const images = [...element.querySelectorAll("img[alt], svg title")]
      .map((image) => image.getAttribute("alt") ?? image.textContent);
    return [element.getAttribute("aria-label"), ...named, ...labels, element.textContent, ...images,
      element.title, element.placeholder].join("").trim();
  }
  const controls = "a[href], button, input:not([type=hidden]), select, textarea, summary, [tabindex='0'], iframe";
  for (const element of document.querySelectorAll(controls)) {
    if (isShown(element) && !element.closest("[aria-hidden=true]") && !nameOf(element)) {
      wrong.push(`has no name: ${short(element)}`);
    }
  }
  for (const image of document.querySelectorAll("img:not([alt])")) wrong.push(`has no alt: ${short(image)}`);
  if (!document.documentElement.lang) wrong.push("the page names no language");
  if (!document.title) wrong.push("the page has no title");
  if (document.querySelectorAll("h1").length !== 1) wrong.push("the page has not one h1");
  const levels = [...document.querySelectorAll("h1, h2, h3, h4, h5, h6")].map((h) => Number(h.tagName[1]));
  levels.forEach((level, k) => {
    if (k > 0 && level > levels[k - 1] + 1) wrong.push(`h${levels[k - 1]} is followed by h${level}`);
  });
  const ids = [...document.querySelectorAll("[id]")].map(({ id }) => id);
  for (const id of new Set(ids.filter((id, k) => ids.indexOf(id) !== k))) wrong.push(`id twice: ${id}`);

  // Keys: what can be clicked can be reached.
  for (const element of document.querySelectorAll("a[href], button, input, select, summary")) {
    if (element.tabIndex < 0 && isShown(element) && element.type !== "hidden" && !element.disabled
      && !element.closest("[aria-hidden=true]")) {
      wrong.push(`cannot be reached by keys: ${short(element)}`);
    }
  }

  // Contrast of text with what is behind it.
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  function rgba(colour) {
    context.clearRect(0, 0, 1, 1);
    context.fillStyle = colour;
    context.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
    return [r, g, b, a / 255];
  }
  function over([r, g, b, a], ground) {
    return [r, g, b].map((value, k) => a * value + (1 - a) * ground[k]);
  }
  function groundOf(element) {
    const layers = [];
    for (let at = element; at; at = at.parentElement) {
      const { backgroundColor, backgroundImage } = getComputedStyle(at);
      if (backgroundImage !== "none") return null;
      const layer = rgba(backgroundColor);
      layers.push(layer);
      if (layer[3] === 1) break;
    }
    const dark = getComputedStyle(document.documentElement).colorScheme.startsWith("dark");
    return layers.reverse().reduce((ground, layer) => over(layer, ground), dark ? [18, 18, 18] : [255, 255, 255]);
  }
  function light(rgb) {
    const [r, g, b] = rgb.map((value) => value / 255)
      .map((value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  }
  const seen = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) {
    const element = walker.currentNode.parentElement;
    if (!walker.currentNode.data.trim() || element.matches("script, style, noscript, option, title")) continue;
    if (!isShown(element) || element.closest("svg, [disabled], [aria-hidden=true]")) continue;
    const style = getComputedStyle(element);
    const { width, height } = element.getBoundingClientRect();
    if (style.clipPath !== "none" || width <= 1 || height <= 1) continue;
    const ground = groundOf(element);
    if (!ground) continue;
    const key = `${style.color} ${ground} ${style.fontSize} ${style.fontWeight}`;
    if (seen.has(key)) continue;
    seen.add(key);
    const [a, b] = [light(over(rgba(style.color), ground)), light(ground)].sort((x, y) => y - x);
    const contrast = (a + 0.05) / (b + 0.05);
    const size = parseFloat(style.fontSize);
    const isLarge = size >= 24 || (size >= 18.66 && Number(style.fontWeight) >= 700);
    if (contrast < (isLarge ? 3 : least) - 0.005) {
      wrong.push(`contrast ${contrast.toFixed(2)}: ${short(element)}`);
    }
  }
  return wrong;
}

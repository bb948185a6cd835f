// Light or dark: what the system says, until the reader says otherwise.
carom.theme = (() => {
  const KEY = "carom-report-theme";
  const listeners = [];
  const system = matchMedia("(prefers-color-scheme: dark)");

  // Some browsers refuse storage to pages opened from a file.
  function remembered() {
    try { return localStorage.getItem(KEY); } catch { return null; }
  }
  function remember(name) {
    try { localStorage.setItem(KEY, name); } catch { /* chosen anew each time */ }
  }

  let chosen = remembered();

  let isLight = false; // on paper, whatever was chosen
  function lighten(wanted) {
    isLight = wanted;
    apply();
  }

  function name() {
    return isLight ? "light" : chosen === "dark" || chosen === "light" ? chosen : system.matches ? "dark" : "light";
  }
  function apply() {
    document.documentElement.dataset.theme = name();
    const button = document.getElementById("theme");
    button.setAttribute("aria-pressed", String(name() === "dark"));
    for (const listener of listeners) listener();
  }
  function toggle() {
    chosen = name() === "dark" ? "light" : "dark";
    remember(chosen);
    apply();
  }

  function colour(variable) {
    return getComputedStyle(document.documentElement).getPropertyValue(`--${variable}`).trim();
  }

  system.addEventListener("change", apply);
  document.getElementById("theme").addEventListener("click", toggle);
  apply();
  return { toggle, lighten, colour, onChange: (listener) => listeners.push(listener) };
})();

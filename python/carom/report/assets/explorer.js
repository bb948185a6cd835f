// Any other column of the history, and the books of every body and pair, over time.
carom.makeExplorer = (data, columns, charts) => {
  const { options } = carom.format;
  const holder = document.getElementById("explored");
  const group = document.getElementById("group");
  const column = document.getElementById("column");
  const PALETTE = ["blue", "orange", "green", "purple", "red", "sky", "yellow", "brown", "grey", "ink"];
  const words = (name) => name.replaceAll("_", " ");
  const isOfSpring = (name) => /\.(length|force)$/.test(name);
  let chart = null;

  const books = data.groups.map(({ title, columns: names }) => ({
    title: title === "whole run" ? title : `${title}: ${names.every(isOfSpring) ? "length and force" : "motion"}`,
    choices: names.map((name) => ({
      title: words(name.slice(name.lastIndexOf(".") + 1)),
      load: async () => ({
        times: Array.from(columns.time),
        unit: data.units[name],
        curves: [{ label: name, colour: "blue", values: columns[name] }],
      }),
    })),
  }));
  for (const ledger of data.ledgers) {
    const entry = ledger.entry.replace("|", " – ");
    const load = (names) => async () => ({
      times: Array.from((await carom.codec.unpack(ledger.time)).array),
      unit: "J",
      curves: await Promise.all(names.map(async (name, index) => ({
        label: words(name),
        colour: PALETTE[index % PALETTE.length],
        values: (await carom.codec.unpack(ledger.columns[name])).array,
      }))),
    });
    const names = Object.keys(ledger.columns);
    if (names.length) {
      books.push({
        title: `${entry}: energy books`,
        choices: [
          { title: "all terms", load: load(names) },
          ...names.map((name) => ({ title: words(name), load: load([name]) })),
        ],
      });
    }
  }
  if (!books.length) return;

  function choose() {
    const { choices } = books[group.value];
    options(column, choices.map(({ title }, index) => [index, title]));
    // The energies of the whole run have their curves already.
    column.value = String(Math.max(0, choices.findIndex(({ title }) => title.startsWith("momentum"))));
    show();
  }
  let shown = 0;
  async function show() {
    const mine = ++shown;
    const book = books[group.value];
    const choice = book.choices[column.value];
    const content = await choice.load();
    if (mine !== shown) return; // another was chosen meanwhile
    chart?.remove();
    chart = charts.add(holder, { id: "explored", title: `${book.title}, ${choice.title}`, ...content });
  }
  options(group, books.map(({ title }, index) => [index, title]));
  group.addEventListener("change", choose);
  column.addEventListener("change", show);
  document.getElementById("explorer").hidden = false;
  choose();
};

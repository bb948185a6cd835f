// Files that the reader takes along: made in the page and handed to the browser, without a network.
carom.save = (() => {
  const { create } = carom.format;

  function name(what, ending) {
    const words = `${document.querySelector("h1").textContent} ${what}`.match(/[\p{L}\p{N}.]+/gu) ?? ["carom"];
    return `${words.join("-").slice(0, 100)}.${ending}`;
  }
  function file(content, what, ending) {
    const href = URL.createObjectURL(content);
    const link = create("a", { href, download: name(what, ending) });
    document.body.append(link); // Firefox wants it there
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(href), 60_000); // when the browser has surely taken it
  }
  function text(content, what, ending, type) {
    file(new Blob([content], { type: `${type};charset=utf-8` }), what, ending);
  }
  function picture(canvas, what) {
    canvas.toBlob((blob) => file(blob, what, "png"), "image/png");
  }

  // Comma-separated lines, quoted where they must be.
  function csv(rows, what) {
    const cell = (value) => (/[",\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
    text(rows.map((row) => `${row.map((value) => cell(String(value ?? ""))).join(",")}\n`).join(""), what, "csv", "text/csv");
  }

  // The rows of a table, numbers with all their digits, and their unit behind where each has its own.
  function rowsOf(table) {
    return [...table.rows].map((row) => {
      const cells = [...row.cells].filter((cell) => !cell.classList.contains("bar"));
      const values = cells.map((cell) => cell.querySelector("data")?.value ?? cell.textContent.trim());
      const unit = row.querySelector(".unit")?.textContent.trim();
      return unit ? [...values, unit] : values;
    });
  }

  function button(label, title, action) {
    const made = create("button", { type: "button", className: "save", title }, label);
    made.setAttribute("aria-label", title);
    made.addEventListener("click", (event) => {
      event.preventDefault(); // in the heading of a fold it would close it
      action(made);
    });
    return made;
  }

  // A button for each table, in its heading.
  function offerTables() {
    for (const card of document.querySelectorAll("section.card:has(table), details.card:has(table)")) {
      const heading = card.querySelector("h2, summary");
      const title = heading.textContent;
      heading.append(button("CSV", `Save the table as CSV: ${title}`, () => csv(rowsOf(card.querySelector("table")), title)));
    }
  }
  return { file, text, picture, csv, button, offerTables };
})();

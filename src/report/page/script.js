"use strict";
(() => {
  const number = (cell) => {
    const text = cell.dataset.v ?? cell.textContent.trim();
    const value = Number(text);
    return text === "" ? null : Number.isNaN(value) ? text : value;
  };
  const compare = (a, b) => {
    if (a === null || b === null) return (a === null) - (b === null);
    if (typeof a === "number" && typeof b === "number") return a - b;
    return String(a).localeCompare(String(b), "en", { numeric: true });
  };
  const sort = (table, head, index) => {
    const descends = head.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", descends ? "descending" : "ascending");
    const body = table.tBodies[0];
    const rows = [...body.rows].map((row) => [number(row.cells[index]), row]);
    const sign = descends ? -1 : 1;
    // What has no value stays last either way.
    rows.sort(([a], [b]) => (a === null || b === null ? compare(a, b) : sign * compare(a, b)));
    body.append(...rows.map(([, row]) => row));
  };
  for (const table of document.querySelectorAll("table.sortable")) {
    [...table.tHead.rows[0].cells].forEach((head, index) => {
      const button = document.createElement("button");
      button.type = "button";
      // The unit stays below, out of the line with the arrow.
      button.append(...[...head.childNodes].filter((node) => node.className !== "unit"));
      button.addEventListener("click", () => sort(table, head, index));
      head.prepend(button);
    });
  }
  for (const tools of document.querySelectorAll(".tools[data-of]")) {
    const table = document.getElementById(tools.dataset.of);
    const input = tools.querySelector("input");
    const told = tools.querySelector("output");
    const filter = () => {
      const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
      let shown = 0;
      for (const row of table.tBodies[0].rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
        shown += !row.hidden;
      }
      told.textContent = words.length ? `${shown} of ${table.tBodies[0].rows.length} rows` : "";
    };
    input.addEventListener("input", filter);
    tools.hidden = false;
  }
  const value = (axis, part) =>
    axis.log ? axis.low * (axis.high / axis.low) ** part : axis.low + part * (axis.high - axis.low);
  for (const picture of document.querySelectorAll(".picture")) {
    const svg = picture.querySelector("svg");
    const data = svg?.querySelector("metadata");
    if (!data) continue;
    const { width, height, panels } = JSON.parse(data.textContent);
    const frame = picture.querySelector(".frame");
    const told = picture.querySelector("output");
    const lines = ["x", "y"].map(() => {
      const line = document.createElement("div");
      line.className = "cross";
      line.hidden = true;
      frame.append(line);
      return line;
    });
    const hide = () => {
      lines.forEach((line) => (line.hidden = true));
      told.textContent = "";
    };
    svg.addEventListener("pointerleave", hide);
    svg.addEventListener("pointermove", (event) => {
      const box = svg.getBoundingClientRect();
      const x = ((event.clientX - box.left) / box.width) * width;
      const y = ((event.clientY - box.top) / box.height) * height;
      const panel = panels.find((p) => x >= p.left && x <= p.right && y >= p.top && y <= p.bottom);
      if (!panel) return hide();
      const at = [
        value(panel.x, (x - panel.left) / (panel.right - panel.left)),
        value(panel.y, (panel.bottom - y) / (panel.bottom - panel.top)),
      ];
      told.textContent = `${panel.x.title}: ${at[0].toPrecision(4)}   ${panel.y.title}: ${at[1].toPrecision(4)}`;
      const place = (px, along) => `${(px / along) * 100}%`;
      Object.assign(lines[0].style, {
        left: `${(x / width) * box.width}px`, width: "1px",
        top: place(panel.top, height), height: place(panel.bottom - panel.top, height),
      });
      Object.assign(lines[1].style, {
        top: `${(y / height) * box.height}px`, height: "1px",
        left: `${(panel.left / width) * box.width}px`,
        width: `${((panel.right - panel.left) / width) * box.width}px`,
      });
      lines.forEach((line) => (line.hidden = false));
    });
  }
})();

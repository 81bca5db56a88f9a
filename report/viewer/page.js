// SPDX-License-Identifier: GPL-3.0-or-later
// What makes the page answer: tables that sort and filter, plans that tell their sensors, exposure, light and
// dark. The page is complete without it. Embedded as it stands; ASCII only.
(() => {
  "use strict";
  const mostUnfiltered = 10;

  const make = (tag, attributes = {}, text = "") => {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
    element.textContent = text;
    return element;
  };

  // Cells hold numbers with narrow spaces and a true minus.
  const numberIn = (text) => parseFloat(text.replace(/[\s\u202f\u00a0]/g, "").replace("\u2212", "-"));

  const compareCells = (column, isNumber) => (a, b) => {
    const [left, right] = [a.cells[column].textContent, b.cells[column].textContent];
    if (!isNumber) return left.localeCompare(right, "en", { numeric: true });
    const [x, y] = [numberIn(left), numberIn(right)];
    if (Number.isNaN(x) || Number.isNaN(y)) return Number.isNaN(x) - Number.isNaN(y);
    return x - y;
  };

  const sortable = (table) => {
    const body = table.tBodies[0];
    if (body.rows.length < 2) return;
    const heads = [...table.tHead.rows[0].cells];
    const rest = body.querySelectorAll("tr.more").length; // rows that stay folded, however they are sorted
    heads.forEach((head, column) => {
      if (!head.textContent.trim()) return;
      const button = make("button", { type: "button", class: "sort" });
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const isNumber = head.classList.contains("n");
        const before = head.getAttribute("aria-sort");
        // The first click shows what one looks for: the largest number, the first name.
        const down = before ? before === "ascending" : isNumber;
        const compare = compareCells(column, isNumber);
        const rows = [...body.rows].sort((a, b) => (down ? compare(b, a) : compare(a, b)));
        body.append(...rows);
        rows.forEach((row, i) => row.classList.toggle("more", i >= rows.length - rest));
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", down ? "descending" : "ascending");
      });
    });
  };

  const filterable = (table) => {
    const rows = [...table.tBodies[0].rows];
    if (rows.length <= mostUnfiltered) return;
    const label = make("label", { class: "filter" }, "Filter ");
    const field = make("input", { type: "search", placeholder: "name or value" });
    const shown = make("span", { "aria-live": "polite" });
    label.append(field, shown);
    table.parentElement.before(label);
    field.addEventListener("input", () => {
      const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
      let count = 0;
      for (const row of rows) {
        const text = row.textContent.toLowerCase();
        row.hidden = !words.every((word) => text.includes(word));
        count += !row.hidden;
      }
      table.classList.toggle("filtered", words.length > 0);
      shown.textContent = words.length ? ` ${count} of ${rows.length}` : "";
    });
  };

  const foldable = (table) => {
    const rest = table.querySelectorAll("tbody tr.more");
    if (!rest.length) return;
    const fold = make("button", { type: "button", class: "fold", "aria-expanded": "false" });
    const tell = (open) => {
      table.classList.toggle("folded", !open);
      fold.setAttribute("aria-expanded", String(open));
      fold.textContent = open ? "Show fewer" : `Show all ${table.tBodies[0].rows.length} rows`;
    };
    fold.addEventListener("click", () => tell(table.classList.contains("folded")));
    table.parentElement.after(fold);
    tell(false);
  };

  /** The nearest sensor in the direction of an arrow key. */
  const neighbour = (sensors, from, key) => {
    const place = (rect) => [Number(rect.getAttribute("x")), Number(rect.getAttribute("y"))];
    const [dx, dy] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
    const [x, y] = place(from);
    let best = from;
    let least = Infinity;
    for (const rect of sensors) {
      const [px, py] = place(rect);
      const ahead = (px - x) * dx + (py - y) * dy;
      const aside = Math.abs((px - x) * dy) + Math.abs((py - y) * dx);
      if (ahead > 0.01 && ahead + 8 * aside < least) {
        least = ahead + 8 * aside;
        best = rect;
      }
    }
    return best;
  };

  const plan = (svg) => {
    const sensors = [...svg.querySelectorAll(".sensors rect")];
    if (!sensors.length) return;
    const figure = svg.closest("figure");
    const readout = make("p", { class: "readout", "aria-live": "polite" }, "Point at the plan, or use the arrow keys on it.");
    svg.after(readout);
    svg.setAttribute("tabindex", "0");
    let chosen = null;
    const choose = (rect) => {
      if (!rect || rect === chosen) return;
      if (chosen) chosen.classList.remove("chosen");
      chosen = rect;
      chosen.classList.add("chosen");
      readout.textContent = rect.querySelector("title").textContent;
    };
    for (const type of ["pointermove", "pointerdown"]) {
      svg.addEventListener(type, (event) => choose(event.target.closest(".sensors rect")));
    }
    svg.addEventListener("keydown", (event) => {
      if (!event.key.startsWith("Arrow")) return;
      event.preventDefault();
      choose(chosen ? neighbour(sensors, chosen, event.key) : sensors[0]);
    });
    const switches = make("div", { class: "switches" });
    for (const [style, name] of [["values", "Numbers"], ["isolux", "Isolux lines"]]) {
      const layer = svg.querySelector(`.${style}`);
      if (!layer) continue;
      const label = make("label");
      const box = make("input", { type: "checkbox" });
      box.checked = true;
      box.addEventListener("change", () => layer.classList.toggle("off", !box.checked));
      label.append(box, ` ${name}`);
      switches.append(label);
    }
    figure.insertBefore(switches, svg);
  };

  /** Brightens and darkens the pictures in linear light, through the page's filter. */
  const exposure = (views) => {
    if (!views) return;
    const gains = document.querySelectorAll("#exposure feFuncR, #exposure feFuncG, #exposure feFuncB");
    const label = make("label", { class: "exposure" }, "Exposure ");
    const slider = make("input", { type: "range", min: "-4", max: "4", step: "0.25", value: "0" });
    const text = make("output", {}, "as rendered");
    label.append(slider, text);
    views.prepend(label);
    slider.addEventListener("input", () => {
      const stops = Number(slider.value);
      gains.forEach((gain) => gain.setAttribute("slope", String(2 ** stops)));
      views.classList.toggle("exposed", stops !== 0);
      text.textContent = stops === 0 ? "as rendered" : `${stops > 0 ? "+" : "\u2212"}${Math.abs(stops)} EV`;
      slider.setAttribute("aria-valuetext", text.textContent);
    });
  };

  const theme = () => {
    const root = document.documentElement;
    const button = make("button", { type: "button", class: "theme" });
    const isDark = () =>
      root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    const tell = () => (button.textContent = isDark() ? "Light page" : "Dark page");
    button.addEventListener("click", () => {
      root.dataset.theme = isDark() ? "light" : "dark";
      tell();
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", tell);
    tell();
    document.querySelector("header").prepend(button);
  };

  /** Paper cannot unfold anything: what is folded away is printed too. */
  const unfoldForPrint = () => {
    let folded = [];
    addEventListener("beforeprint", () => {
      folded = [...document.querySelectorAll("details:not([open])")];
      folded.forEach((details) => (details.open = true));
    });
    addEventListener("afterprint", () => folded.forEach((details) => (details.open = false)));
  };

  theme();
  unfoldForPrint();
  document.querySelectorAll(".table table").forEach((table) => {
    sortable(table);
    filterable(table);
    foldable(table);
  });
  document.querySelectorAll("svg.plan").forEach(plan);
  exposure(document.querySelector(".views"));
})();

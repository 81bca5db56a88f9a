#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws columns of a CSV as a chart in SVG: points and lines by series, axes logarithmic or linear.

    chart.py versus.csv versus.svg -x seconds -y error_pct --series method --filter scene=refoffice --front
    chart.py iterations.csv links.svg -x iteration -y links --linear x --series method --slope -1

Needs Python's standard library only.
"""
import argparse
import csv
import math
import sys
from xml.sax.saxutils import escape

WIDTH, HEIGHT = 760, 480
LEFT, RIGHT, TOP, BOTTOM = 76, 20, 44, 58

# Colours that stand apart on white and, brightened, on dark grey; shapes say the same to who sees no colours.
LIGHT = ["#0060a8", "#c44e00", "#007a57", "#a03a86", "#7a6300", "#444444"]
DARK = ["#5cb3f5", "#ff9a52", "#3fcf9f", "#ee8fd2", "#dfc24a", "#bbbbbb"]

SHAPES = """
text { font: 13px system-ui, sans-serif; stroke: none }
.title { font-size: 15px; font-weight: 600 }
.minor { stroke-width: .5; opacity: .6 }
.frame, .line { fill: none }
.line { stroke-width: 2; stroke-linejoin: round }
.slope { stroke-width: 1.5; stroke-dasharray: 6 4 }
"""


def style():
    """Every colour twice; no variables, since not every viewer of SVG knows them."""
    def colours(ink, ground, grid, series):
        rules = [f"text {{ fill: {ink} }}", f".frame, .slope {{ stroke: {ink} }}", f".ground {{ fill: {ground} }}",
                 f".grid, .minor {{ stroke: {grid} }}"]
        rules += [f".s{i} {{ fill: {own} }} .l{i} {{ stroke: {own} }}" for i, own in enumerate(series)]
        return "\n".join(rules)

    dark = colours("#e6e6e6", "#1c1d20", "#45474d", DARK)
    return (colours("#222222", "#ffffff", "#d0d0d0", LIGHT) + SHAPES +
            "@media (prefers-color-scheme: dark) {\n" + dark + "\n}")


def number(value):
    """As short as a label may be: 0.01, 5, 2,000, 10⁶."""
    if value != 0 and not 1e-4 <= abs(value) < 1e5:
        power = math.floor(math.log10(abs(value)) + 1e-9)
        factor = value / 10**power
        superscript = str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return ("" if abs(factor - 1) < 1e-6 else f"{factor:.3g}·") + f"10{superscript}"
    return f"{value:,.10g}"


class Axis:
    """From values to places on the page, and the ticks between."""

    def __init__(self, values, log, begin, end):
        self.log, self.begin, self.end = log, begin, end
        low, high = min(values), max(values)
        if log:
            low, high = math.log10(low), math.log10(high)
            margin = max(0.04 * (high - low), 0.05)
            self.low, self.high = low - margin, high + margin
        else:
            low = min(low, 0.0) if low < 0.4 * high else low
            margin = 0.04 * (high - low) or 1.0
            self.low, self.high = (low if low == 0.0 else low - margin), high + margin

    def place(self, value):
        at = math.log10(value) if self.log else value
        return self.begin + (at - self.low) / (self.high - self.low) * (self.end - self.begin)

    def ticks(self):
        """Pairs of value and whether it is labelled."""
        if self.log:
            decades = range(math.floor(self.low), math.ceil(self.high) + 1)
            wide = self.high - self.low
            labelled = {1} if wide > 3.5 else {1, 2, 5} if wide > 0.7 else set(range(1, 10))
            every = [(factor * 10.0**decade, factor in labelled) for decade in decades for factor in range(1, 10)]
            return [tick for tick in every if self.low <= math.log10(tick[0]) <= self.high]
        step = 10 ** math.floor(math.log10((self.high - self.low) / 4))
        step *= next(factor for factor in (1, 2, 5, 10) if (self.high - self.low) / (step * factor) <= 8)
        first = math.ceil(self.low / step - 1e-9)
        return [(i * step, True) for i in range(first, math.floor(self.high / step + 1e-9) + 1)]


def read_points(arguments):
    """Points by series, in the order that the series first appear."""
    wanted = [text.split("=", 1) for text in arguments.filter]
    series = {}
    with open(arguments.table, newline="", encoding="utf-8") as file:
        rows = csv.DictReader(file)
        named = [arguments.x, arguments.y, *arguments.series, *(key for key, _ in wanted)]
        missing = [name for name in named if name not in (rows.fieldnames or [])]
        if missing:
            sys.exit(f"{arguments.table} has no column {', '.join(missing)}; it has {', '.join(rows.fieldnames or [])}")
        for row in rows:
            if any(row[key] not in value.split("|") for key, value in wanted):
                continue
            try:
                point = float(row[arguments.x]), float(row[arguments.y])
            except ValueError:
                continue  # an empty cell
            usable = all(math.isfinite(v) and (v > 0 or axis in arguments.linear) for v, axis in zip(point, "xy"))
            if usable:
                series.setdefault(", ".join(row[name] for name in arguments.series), []).append(point)
    if not series:
        sys.exit("no row is left to draw")
    return series


def fitted_power(points):
    """The slope of the straight line in logarithms that is nearest to all points."""
    across = [math.log(x) for x, _ in points]
    up = [math.log(y) for _, y in points]
    middle = sum(across) / len(across), sum(up) / len(up)
    spread = sum((x - middle[0]) ** 2 for x in across)
    return sum((x - middle[0]) * (y - middle[1]) for x, y in zip(across, up)) / spread


def front_of(points):
    """What no other point is left of and below."""
    front = []
    for point in sorted(points):
        if not front or point[1] < front[-1][1]:
            front.append(point)
    return front


def marker(number_of_series, x, y, size=4.0):
    half = 1.4 * size  # of the diamond
    shapes = [
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{size}"',
        f'<rect x="{x - size:.1f}" y="{y - size:.1f}" width="{2 * size}" height="{2 * size}"',
        f'<path d="M{x:.1f} {y - 1.3 * size:.1f}l{1.3 * size} {2.2 * size}h{-2.6 * size}z"',
        f'<path d="M{x:.1f} {y - half:.1f}l{half} {half}l{-half} {half}l{-half} {-half}z"',
    ]
    colour = number_of_series % len(LIGHT)
    return f'{shapes[number_of_series % len(shapes)]} class="s{colour}"'


def draw_axes(x, y, arguments):
    yield f'<rect class="ground" width="{WIDTH}" height="{HEIGHT}"/>'
    for value, labelled in x.ticks():
        at = x.place(value)
        yield f'<path class="{"grid" if labelled else "minor"}" d="M{at:.1f} {y.begin}V{y.end}"/>'
        if labelled:
            yield f'<text x="{at:.1f}" y="{y.begin + 18}" text-anchor="middle">{number(value)}</text>'
    for value, labelled in y.ticks():
        at = y.place(value)
        yield f'<path class="{"grid" if labelled else "minor"}" d="M{x.begin} {at:.1f}H{x.end}"/>'
        if labelled:
            yield f'<text x="{x.begin - 8}" y="{at + 4:.1f}" text-anchor="end">{number(value)}</text>'
    yield f'<rect class="frame" x="{x.begin}" y="{y.end}" width="{x.end - x.begin}" height="{y.begin - y.end}"/>'
    yield f'<text class="title" x="{x.begin}" y="26">{escape(arguments.title)}</text>'
    middle = (y.begin + y.end) / 2
    yield (f'<text x="{(x.begin + x.end) / 2}" y="{HEIGHT - 14}" text-anchor="middle">'
           f"{escape(arguments.x_label or arguments.x)}</text>")
    yield (f'<text transform="translate(18 {middle}) rotate(-90)" text-anchor="middle">'
           f"{escape(arguments.y_label or arguments.y)}</text>")


def draw_slope(x, y, points, slope):
    """A line of this slope (logarithmic axes: the power) through the geometric middle of all points."""
    def to_axis(axis, value):
        return math.log10(value) if axis.log else value

    across = [to_axis(x, point[0]) for point in points]
    up = [to_axis(y, point[1]) for point in points]
    centre = sum(across) / len(across), sum(up) / len(up)
    ends = []
    for at in (min(across), max(across)):
        along = centre[1] + slope * (at - centre[0])
        ends.append((at, min(max(along, y.low), y.high)))
    ends = [(centre[0] + (v - centre[1]) / slope if slope else at, v) for at, v in ends]
    places = [(x.place(10**a if x.log else a), y.place(10**b if y.log else b)) for a, b in ends]
    yield '<path class="slope" d="M' + "L".join(f"{a:.1f} {b:.1f}" for a, b in places) + '"/>'


def draw_legend(names, x, y, slope, points):
    """In the corner that hides the fewest points."""
    entries = [*enumerate(names), *([(None, f"slope {slope:g}")] if slope is not None else [])]
    wide, high = 34 + 7.5 * max(len(name) for _, name in entries), 20 * len(entries) + 6

    def hidden(corner):
        return sum(corner[0] - 8 < x.place(a) < corner[0] + wide + 8 and corner[1] - 8 < y.place(b) < corner[1] + high + 8
                   for a, b in points)

    corners = [(left, top) for left in (x.end - wide - 8, x.begin + 8) for top in (y.end + 8, y.begin - high - 8)]
    left, top = min(corners, key=hidden)
    yield (f'<rect class="ground" opacity=".85" x="{left:.1f}" y="{top}" width="{wide:.1f}" '
           f'height="{high}"/>')
    for row, (i, name) in enumerate(entries):
        at = top + 16 + 20 * row
        if i is None:
            yield f'<path class="slope" d="M{left + 4:.1f} {at - 4}h20"/>'
        else:
            yield marker(i, left + 14, at - 4) + "/>"
        yield f'<text x="{left + 30:.1f}" y="{at}">{escape(name)}</text>'


def draw(series, arguments):
    every = [point for points in series.values() for point in points]
    x = Axis([point[0] for point in every], "x" not in arguments.linear, LEFT, WIDTH - RIGHT)
    y = Axis([point[1] for point in every], "y" not in arguments.linear, HEIGHT - BOTTOM, TOP)
    yield (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" '
           f'height="{HEIGHT}" role="img">\n<title>{escape(arguments.title)}</title>\n<style>{style()}</style>')
    yield from draw_axes(x, y, arguments)
    for i, points in enumerate(series.values()):
        line = front_of(points) if arguments.front else sorted(points)
        if arguments.front:
            for point in points:
                yield marker(i, x.place(point[0]), y.place(point[1]), 2.0) + ' opacity=".4"/>'
        places = "L".join(f"{x.place(a):.1f} {y.place(b):.1f}" for a, b in line)
        yield f'<path class="line l{i % len(LIGHT)}" d="M{places}"/>'
        for point in line:
            title = escape(f"{arguments.x} {point[0]:.4g}, {arguments.y} {point[1]:.4g}")
            shape = marker(i, x.place(point[0]), y.place(point[1]))
            yield f"{shape}><title>{title}</title></{shape[1:shape.index(' ')]}>"
    if arguments.slope is not None:
        yield from draw_slope(x, y, every, arguments.slope)
    yield from draw_legend(list(series), x, y, arguments.slope, every)
    yield "</svg>"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("table", help="a CSV with a header")
    parser.add_argument("output", help="the SVG")
    parser.add_argument("-x", required=True, metavar="COLUMN")
    parser.add_argument("-y", required=True, metavar="COLUMN")
    parser.add_argument("--series", action="append", default=[], metavar="COLUMN",
                        help="parts the rows; may be given again")
    parser.add_argument("--filter", action="append", default=[], metavar="COLUMN=VALUE[|VALUE]", help="rows to take")
    parser.add_argument("--title", default="")
    parser.add_argument("--x-label")
    parser.add_argument("--y-label")
    parser.add_argument("--linear", default="", choices=["", "x", "y", "xy"], help="axes that are not logarithmic")
    parser.add_argument("--front", action="store_true", help="the line runs over what no other point beats in both")
    parser.add_argument("--slope", type=float, help="a reference line: the power of y over x on logarithmic axes")
    parser.add_argument("--fit", action="store_true", help="the legend tells each series' own power of y over x")
    arguments = parser.parse_args()
    series = read_points(arguments)
    if arguments.fit:
        series = {f"{name}: slope {fitted_power(points):.2f}": points for name, points in series.items()}
    drawing = "\n".join(draw(series, arguments)) + "\n"
    with open(arguments.output, "w", encoding="utf-8") as file:
        file.write(drawing)


if __name__ == "__main__":
    main()

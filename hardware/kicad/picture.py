"""Pictures of the finished files: the schematic and the board as SVG. Usage: picture.py FOLDER NAME OUTPUT"""

import sys
from html import escape
from math import cos, radians, sin
from pathlib import Path

from expression import child, children, parse

INK = {"wire": "#008000", "body": "#840000", "fill": "#ffffe0", "text": "#006464", "label": "#101010", "note": "#0000c0"}


def turned(x, y, angle):
    """Turns counter-clockwise as seen, y pointing down."""
    c, s = cos(radians(angle)), sin(radians(angle))
    return x * c + y * s, y * c - x * s


class Svg:
    def __init__(self, left, top, width, height, background):
        self.lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="{left:g} {top:g} {width:g} {height:g}" width="{width:g}mm" height="{height:g}mm">',
            f'<rect x="{left:g}" y="{top:g}" width="{width:g}" height="{height:g}" fill="{background}"/>']

    def path(self, points, stroke="none", width=0.0, fill="none", closed=False):
        steps = " L".join(f"{x:.3f} {y:.3f}" for x, y in points)
        end = "Z" if closed else ""
        self.lines.append(f'<path d="M{steps}{end}" stroke="{stroke}" stroke-width="{width:g}" fill="{fill}" '
                          'stroke-linecap="round" stroke-linejoin="round"/>')

    def circle(self, x, y, radius, fill="none", stroke="none", width=0.0):
        self.lines.append(f'<circle cx="{x:.3f}" cy="{y:.3f}" r="{radius:.3f}" fill="{fill}" stroke="{stroke}" stroke-width="{width:g}"/>')

    def text(self, words, x, y, size, color, anchor="start", angle=0):
        spin = f' transform="rotate({-angle:g} {x:.3f} {y:.3f})"' if angle else ""
        self.lines.append(f'<text x="{x:.3f}" y="{y:.3f}" font-family="DejaVu Sans Mono, monospace" font-size="{size:g}" '
                          f'text-anchor="{anchor}" fill="{color}"{spin}>{escape(words)}</text>')

    def save(self, path):
        path.write_text("\n".join(self.lines + ["</svg>"]) + "\n", encoding="utf-8")


def place(node):
    found = child(node, "at")
    return float(found[1]), float(found[2]), float(found[3]) if len(found) > 3 else 0.0


def point(node):
    return float(node[1]), float(node[2])


def schematic(sheet, output):
    svg = Svg(0, 0, 420, 297, "#ffffff")
    library = {symbol[1]: symbol for symbol in children(child(sheet, "lib_symbols"), "symbol")}
    for wire in children(sheet, "wire"):
        svg.path([point(xy) for xy in children(child(wire, "pts"), "xy")], INK["wire"], 0.2)
    for symbol in children(sheet, "symbol"):
        draw_symbol(svg, symbol, library[child(symbol, "lib_id")[1]])
    for dot in children(sheet, "junction"):
        svg.circle(*place(dot)[:2], 0.5, INK["wire"])
    for cross in children(sheet, "no_connect"):
        x, y, _ = place(cross)
        svg.path([(x - 0.6, y - 0.6), (x + 0.6, y + 0.6)], INK["note"], 0.2)
        svg.path([(x - 0.6, y + 0.6), (x + 0.6, y - 0.6)], INK["note"], 0.2)
    for label in children(sheet, "label"):
        x, y, angle = place(label)
        draw_label(svg, label[1], x, y, angle)
    for note in children(sheet, "text"):
        x, y, _ = place(note)
        svg.text(note[1], x, y, 3, INK["note"])
    title = child(sheet, "title_block")
    svg.text(child(title, "title")[1], 320, 280, 3.5, INK["body"])
    svg.text(f"LibreRVAC, revision {child(title, 'rev')[1]}, {child(title, 'date')[1]}", 320, 286, 2.5, INK["body"])
    svg.save(output)


def draw_label(svg, words, x, y, angle):
    if angle in (90, 270):
        svg.text(words, x - 0.3, y, 1.5, INK["label"], "start" if angle == 90 else "end", 90)
    else:
        svg.text(words, x, y - 0.3, 1.5, INK["label"], "end" if angle == 180 else "start")


def draw_symbol(svg, symbol, shape):
    x, y, angle = place(symbol)

    def spot(node):
        left, up = point(node)
        dx, dy = turned(left, -up, angle)
        return x + dx, y + dy

    show = (child(shape, "pin_numbers") is None, "hide" not in child(shape, "pin_names"))
    for part in children(shape, "symbol"):
        for line in children(part, "polyline"):
            points = [spot(xy) for xy in children(child(line, "pts"), "xy")]
            solid = child(child(line, "fill"), "type")[1] == "outline"
            svg.path(points, INK["body"], 0.25, INK["body"] if solid else "none")
        for box in children(part, "rectangle"):
            (ax, ay), (bx, by) = point(child(box, "start")), point(child(box, "end"))
            corners = [spot(["", cx, cy]) for cx, cy in ((ax, ay), (bx, ay), (bx, by), (ax, by))]
            svg.path(corners, INK["body"], 0.25, INK["fill"], closed=True)
        for ring in children(part, "circle"):
            svg.circle(*spot(child(ring, "center")), float(child(ring, "radius")[1]), stroke=INK["body"], width=0.25)
        for pin in children(part, "pin"):
            if "hide" not in pin:
                draw_pin(svg, pin, spot, angle, show)
    for entry in children(symbol, "property"):
        if "hide" not in child(entry, "effects") and entry[1] in ("Reference", "Value"):
            left, top, _ = place(entry)
            centred = "#" in child_value(symbol, "Reference")
            svg.text(entry[2], left, top + 0.5, 1.5, INK["text"], "middle" if centred else "start")


def child_value(symbol, key):
    return next(entry[2] for entry in children(symbol, "property") if entry[1] == key)


def draw_pin(svg, pin, spot, angle, show):
    left, up, away = place(pin)
    length = float(child(pin, "length")[1])
    dx, dy = turned(length, 0, away)
    begin, end = spot(["", left, up]), spot(["", left + dx, up - dy])
    svg.path([begin, end], INK["body"], 0.2)
    along = (away + angle) % 360
    numbers, names = show
    middle = ((begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2)
    if numbers:
        svg.text(child(pin, "number")[1], middle[0], middle[1] - 0.3, 1.1, INK["body"], "middle", 90 if along in (90, 270) else 0)
    if names and child(pin, "name")[1] != "~":
        inner = 0.6
        x, y = {0: (end[0] + inner, end[1] + 0.5), 180: (end[0] - inner, end[1] + 0.5), 90: (end[0], end[1] - inner), 270: (end[0], end[1] + inner + 1)}[along]
        svg.text(child(pin, "name")[1], x, y, 1.3, INK["text"], {0: "start", 180: "end"}.get(along, "middle"))


COLORS = {"F.Cu": "#c8553d", "B.Cu": "#3d6fc8"}


def board(pcb, output, layer):
    """The board from above: copper of one layer, pads, holes, silk screen."""
    outline = [point(child(line, key)) for line in children(pcb, "gr_line") for key in ("start", "end")]
    left, top = min(x for x, _ in outline), min(y for _, y in outline)
    right, bottom = max(x for x, _ in outline), max(y for _, y in outline)
    svg = Svg(left - 2, top - 2, right - left + 4, bottom - top + 4, "#f4f4f4")
    svg.path([(left, top), (right, top), (right, bottom), (left, bottom)], fill="#1f3d2b", closed=True)
    for zone in children(pcb, "zone"):
        if child(zone, "layer")[1] == layer:
            for filled in children(zone, "filled_polygon"):
                svg.path([point(xy) for xy in children(child(filled, "pts"), "xy")], fill="#2f6b45" if "GND" in child(zone, "net_name")[1] else "#5b8f3a", closed=True)
    for track in children(pcb, "segment"):
        if child(track, "layer")[1] == layer:
            ends = [point(child(track, "start")), point(child(track, "end"))]
            svg.path(ends, COLORS[layer], float(child(track, "width")[1]))
    for via in children(pcb, "via"):
        svg.circle(*place(via)[:2], 0.3, "#b0b0b0")
        svg.circle(*place(via)[:2], 0.15, "#101010")
    for footprint in children(pcb, "footprint"):
        draw_footprint(svg, footprint, layer)
    if layer == "F.Cu":
        for text in children(pcb, "gr_text"):
            x, y, _ = place(text)
            size = float(child(child(child(text, "effects"), "font"), "size")[1])
            svg.text(text[1], x, y + size / 2, size * 1.3, "#ffffff", "middle")
    svg.save(output)


def draw_footprint(svg, footprint, layer):
    x, y, angle = place(footprint)

    def spot(px, py):
        dx, dy = turned(px, py, angle)
        return x + dx, y + dy

    for pad in children(footprint, "pad"):
        draw_pad(svg, pad, spot, layer)
    if layer != "F.Cu":
        return
    for line in children(footprint, "fp_line"):
        if child(line, "layer")[1] == "F.SilkS":
            svg.path([spot(*point(child(line, "start"))), spot(*point(child(line, "end")))], "#ffffff", 0.12)
    for text in children(footprint, "fp_text"):
        if child(text, "layer")[1] == "F.SilkS" and text[1] == "reference":
            px, py, _ = place(text)
            left, top = spot(px, py)
            svg.text(text[2], left, top + 0.35, 1.0, "#ffffff", "middle")


def draw_pad(svg, pad, spot, layer):
    px, py, own = place(pad)
    through = pad[2] != "smd"
    if not through and layer != "F.Cu":
        return
    width, height = float(child(pad, "size")[1]) / 2, float(child(pad, "size")[2]) / 2
    left, top = spot(px, py)
    corners = [turned(dx, dy, own) for dx, dy in ((-width, -height), (width, -height), (width, height), (-width, height))]
    if pad[3] == "circle":
        svg.circle(left, top, width, "#d8b45a")
    else:
        svg.path([(left + dx, top + dy) for dx, dy in corners], fill="#d8b45a", closed=True)
    if through:
        svg.circle(left, top, float(child(pad, "drill")[1]) / 2, "#101010")


def main():
    folder, name, output = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
    output.mkdir(parents=True, exist_ok=True)
    schematic(parse((folder / f"{name}.kicad_sch").read_text(encoding="utf-8")), output / "schematic.svg")
    pcb = parse((folder / f"{name}.kicad_pcb").read_text(encoding="utf-8"))
    board(pcb, output / "board-upper.svg", "F.Cu")
    board(pcb, output / "board-lower.svg", "B.Cu")


main()

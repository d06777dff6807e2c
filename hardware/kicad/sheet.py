"""Draws the schematic: symbols, the wires that the design names, and for every other pin a short wire with a label."""

from expression import Text, dump, identifier
from symbols import GRID, font, library

STEP = {"left": (-1, 0), "right": (1, 0), "up": (0, -1), "down": (0, 1)}
ANGLE = {"right": 0, "up": 90, "left": 180, "down": 270}
TURN = {0: lambda x, y: (x, y), 90: lambda x, y: (y, -x), 180: lambda x, y: (-x, -y), 270: lambda x, y: (-y, x)}


def turned(direction, angle):
    moved = TURN[angle](*STEP[direction])
    return next(name for name, step in STEP.items() if step == moved)


class Sheet:
    def __init__(self, design, paper="A3"):
        self.design, self.paper = design, paper
        self.symbols = library()
        self.used = set()
        self.items, self.segments, self.ends = [], [], []
        self.power_count = 0
        self.pins = {}
        self.project = identifier(design.name, "root")

    def draw(self):
        for part in self.design.parts:
            self.place(part)
        served = self.draw_wires()
        for (reference, pin), (x, y, direction) in self.pins.items():
            part = self.design.part(reference)
            net = part.nets.get(pin)
            if net is None:
                self.items.append(["no_connect", at(x, y), uid("nc", reference, pin)])
            elif (reference, pin) not in served:
                self.stub(net, x, y, direction, f"{reference}.{pin}")
        for net, x, y in self.design.flags:
            self.flag(net, x, y)
        for text, x, y, size in self.design.notes:
            self.note(text, x, y, size)
        self.junctions()
        return self.expression()

    def place(self, part):
        symbol = self.symbols[part.symbol]
        self.used.add(part.symbol)
        x, y, angle = part.sheet
        seen = set()
        for entry in symbol.pins:
            pin, away = str(entry[0]), entry[5]
            dx, dy = TURN[angle](entry[3], entry[4])
            if (dx, dy) not in seen:
                self.pins[(part.reference, pin)] = (x + dx, y + dy, turned(away, angle))
            seen.add((dx, dy))
        self.items.append(self.instance(part, symbol, x, y, angle))

    def instance(self, part, symbol, x, y, angle):
        # Text is kept horizontal: KiCad turns fields with their symbol.
        turned_field = "90" if angle in (90, 270) else "0"
        fields = [("Reference", part.reference, symbol.labels[0], False), ("Value", part.value, symbol.labels[1], False)]
        if angle in (90, 270) and len(symbol.pins) == 2:
            fields = [("Reference", part.reference, (-0.9, -0.9), False), ("Value", part.value, (-0.9, 0.95), False)]
        elif angle in (90, 270) and part.reference.startswith("Q"):
            above = -2.5 if angle == 90 else 2.4
            fields = [("Reference", part.reference, (-1, above), False), ("Value", part.value, (-1, above + 0.8), False)]
        fields += [("Footprint", part.footprint, (0, 0), True), ("Datasheet", "", (0, 0), True),
                   ("Manufacturer", part.maker, (0, 0), True), ("MPN", part.number, (0, 0), True)]
        made = ["symbol", ["lib_id", Text(f"{self.design.name}:{part.symbol}")], at(x, y, angle), ["unit", "1"]]
        made += [["in_bom", "yes" if part.bought else "no"], ["on_board", "yes"], uid("symbol", part.reference)]
        for index, (key, value, (dx, dy), hidden) in enumerate(fields):
            effects = ["effects", font(1.27), ["justify", "left"]] + (["hide"] if hidden else [])
            where = ["at", (x + dx) * GRID, (y + dy) * GRID, turned_field]
            made.append(["property", Text(key), Text(value), ["id", str(index)], where, effects])
        for entry in symbol.pins:
            made.append(["pin", Text(str(entry[0])), uid("pin", part.reference, entry[0])])
        return made

    def draw_wires(self):
        """A wire is a list of pins "R1.2" and corners (x, y); ends that are pins count as connected."""
        served = set()
        for wire in self.design.wires:
            points = []
            for stop in wire:
                if isinstance(stop, str):
                    reference, pin = stop.split(".")
                    served.add((reference, pin))
                    points.append(self.pins[(reference, pin)][:2])
                else:
                    points.append(self.corner(stop, points))
            for begin, end in zip(points, points[1:]):
                for leg in legs(begin, end):
                    self.segment(*leg)
        for (x, y), (net, direction) in self.design.labels.items():
            self.stub(net, x, y, direction, f"label {x} {y}")
        return served

    @staticmethod
    def corner(stop, points):
        x, y = stop
        return (points[-1][0] if x is None else x, points[-1][1] if y is None else y)

    def segment(self, begin, end):
        if begin == end:
            return
        self.segments.append((begin, end))
        self.items.append(["wire", ["pts", xy(*begin), xy(*end)], stroke(), uid("wire", *begin, *end)])

    def stub(self, net, x, y, direction, name):
        """A wire of one grid unit with the net's name: a supply's symbol, or a label."""
        dx, dy = STEP[direction]
        end = (x + dx, y + dy)
        self.segment((x, y), end)
        if net in self.design.rails:
            self.supply(net, end, direction, name)
        else:
            justify = ["justify", "left" if direction in ("right", "up") else "right", "bottom"]
            made = ["label", Text(net), ["at", end[0] * GRID, end[1] * GRID, str(ANGLE[direction])]]
            self.items.append(made + [["effects", font(1.27), justify], uid("label", name)])

    def supply(self, net, end, direction, name):
        ground = self.design.rails[net] == "down"
        upright = "down" if ground else "up"
        turn = next(angle for angle in (0, 90, 180, 270) if turned(upright, angle) == direction)
        self.power_count += 1
        self.power_instance(net, end, turn, f"#PWR{self.power_count:03}", name)

    def power_instance(self, symbol_name, position, turn, reference, name):
        self.used.add(symbol_name)
        symbol = self.symbols[symbol_name]
        x, y = position
        made = ["symbol", ["lib_id", Text(f"{self.design.name}:{symbol_name}")], at(x, y, turn), ["unit", "1"]]
        made += [["in_bom", "yes"], ["on_board", "yes"], uid("power", name, symbol_name)]
        dx, dy = TURN[turn](*symbol.labels[1])
        justify = [] if turn in (0, 180) else [["justify", "right" if dx < 0 else "left"]]
        shown = symbol_name not in ("GND", "PWR_FLAG")
        values = [("Reference", reference, (0, 0), False), ("Value", symbol_name, (dx, dy), shown)]
        for index, (key, value, (left, top), visible) in enumerate(values):
            effects = ["effects", font(1.27)] + justify + ([] if visible else ["hide"])
            place = ["at", (x + left) * GRID, (y + top) * GRID, "90" if turn in (90, 270) else "0"]
            made.append(["property", Text(key), Text(value), ["id", str(index)], place, effects])
        made.append(["pin", Text("1"), uid("power pin", name, symbol_name)])
        self.items.append(made)
        self.ends.append((position, reference, symbol_name, turn))

    def flag(self, net, x, y):
        """Says that a net is driven from outside."""
        self.power_count += 1
        self.power_instance("PWR_FLAG", (x, y), 0, f"#FLG{self.power_count:03}", f"flag {net}")
        self.stub(net, x, y, "right", f"flag {net}")

    def note(self, text, x, y, size):
        effects = ["effects", font(size), ["justify", "left", "bottom"]]
        self.items.append(["text", Text(text), ["at", x * GRID, y * GRID, "0"], effects, uid("note", text)])

    def junctions(self):
        """A dot where a wire ends on another, or where three ends meet."""
        ends = [point for segment in self.segments for point in segment]
        ends += [position[:2] for position in self.pins.values()]
        for point in sorted(set(ends)):
            inside = any(within(point, segment) for segment in self.segments)
            if inside or ends.count(point) > 2:
                dot = ["junction", at(*point), ["diameter", "0"], ["color", "0", "0", "0", "0"], uid("dot", *point)]
                self.items.append(dot)

    def expression(self):
        design = self.design
        title = ["title_block", ["title", Text(design.title)], ["date", Text(design.date)], ["rev", Text(design.revision)],
                 ["company", Text("LibreRVAC")], ["comment", "1", Text("GPL-3.0-or-later")]]
        embedded = ["lib_symbols"] + [self.symbols[name].expression(design.name) for name in sorted(self.used)]
        paths = ["symbol_instances"]
        for item in self.items:
            if item[0] == "symbol":
                paths.append(instance_path(item))
        paths[1:] = sorted(paths[1:], key=lambda path: path[1])
        head = ["kicad_sch", ["version", "20211123"], ["generator", "eeschema"], ["uuid", self.project], ["paper", Text(self.paper)]]
        order = ["junction", "no_connect", "wire", "text", "label", "symbol"]
        items = sorted(self.items, key=lambda item: order.index(item[0]))
        sheet = ["sheet_instances", ["path", Text("/"), ["page", Text("1")]]]
        return head + [title, embedded] + items + [sheet, paths]


def instance_path(item):
    found = {entry[1]: entry[2] for entry in item if isinstance(entry, list) and entry[0] == "property"}
    identity = next(entry[1] for entry in item if isinstance(entry, list) and entry[0] == "uuid")
    return ["path", Text(f"/{identity}"), ["reference", Text(found["Reference"])], ["unit", "1"],
            ["value", Text(found["Value"])], ["footprint", Text(found.get("Footprint", ""))]]


def legs(begin, end):
    """First along the sheet, then up or down."""
    corner = (end[0], begin[1])
    return [leg for leg in ((begin, corner), (corner, end)) if leg[0] != leg[1]]


def within(point, segment):
    (ax, ay), (bx, by) = segment
    x, y = point
    if ax == bx == x:
        return min(ay, by) < y < max(ay, by)
    return ay == by == y and min(ax, bx) < x < max(ax, bx)


def at(x, y, angle=None):
    made = ["at", x * GRID, y * GRID]
    return made if angle is None else made + [str(angle)]


def xy(x, y):
    return ["xy", x * GRID, y * GRID]


def stroke():
    return ["stroke", ["width", 0], ["type", "default"], ["color", "0", "0", "0", "0"]]


def uid(*names):
    return ["uuid", identifier(*names)]


def library_file(design):
    """The project's own symbol library."""
    symbols = library()
    made = ["kicad_symbol_lib", ["version", "20211014"], ["generator", "kicad_symbol_editor"]]
    return dump(made + [symbols[name].expression("") for name in sorted(symbols)]) + "\n"

"""Symbols of our own for the schematic: plain shapes with pins on a grid of 2.54 mm.

Positions here are in units of that grid, x to the right and y down as on the sheet. A pin is (number, name, electrical
type, x, y, direction in which it points away from the body), x and y being its free end.
"""

from expression import Text

GRID = 2.54
AWAY = {"left": 0, "right": 180, "up": 270, "down": 90}


class Symbol:
    """A shape, its pins, and where reference and value stand."""

    def __init__(self, name, prefix, shapes, pins, numbers=False, names=False, labels=((0.6, -0.5), (0.6, 0.5)), power=False):
        self.name, self.prefix, self.shapes, self.pins = name, prefix, shapes, pins
        self.numbers, self.names, self.labels, self.power = numbers, names, labels, power

    def expression(self, library):
        """The symbol as it stands in a library, or (with the library's name) embedded in a sheet."""
        full = f"{library}:{self.name}" if library else self.name
        head = ["symbol", Text(full)]
        if self.power:
            head.append(["power"])
        if not self.numbers:
            head.append(["pin_numbers", "hide"])
        names = ["pin_names", ["offset", 0.508]]
        if not self.names:
            names.append("hide")
        head += [names, ["in_bom", "no" if self.power else "yes"], ["on_board", "no" if self.power else "yes"]]
        for index, (key, value) in enumerate(
            [("Reference", self.prefix), ("Value", self.name), ("Footprint", ""), ("Datasheet", "")]
        ):
            effects = ["effects", font(1.27)] + (["hide"] if index > 1 else [])
            head.append(["property", Text(key), Text(value), ["id", str(index)], ["at", 0, 0, 0], effects])
        body = ["symbol", Text(f"{self.name}_0_1")] + [shape(item) for item in self.shapes]
        pins = ["symbol", Text(f"{self.name}_1_1")] + [pin(*item) for item in self.pins]
        return head + [body, pins]


def font(size):
    return ["font", ["size", size, size]]


def point(name, x, y):
    return [name, x * GRID, -y * GRID]


def pin(number, name, kind, x, y, away, length=None, hidden=False):
    """KiCad's angle of a pin points from its free end into the body."""
    default = 0 if kind == "power_symbol" else 1
    length = default if length is None else length
    made = ["pin", "power_in" if kind == "power_symbol" else kind, "line"]
    made.append(["at", x * GRID, -y * GRID, str(AWAY[away])])
    made.append(["length", length * GRID])
    if hidden or kind == "power_symbol":
        made.append("hide")
    made.append(["name", Text(name), ["effects", font(1.27)]])
    made.append(["number", Text(str(number)), ["effects", font(1.27)]])
    return made


def shape(item):
    """A line ("line", points), a filled outline ("area", points), a box, or a circle."""
    stroke = ["stroke", ["width", 0.254], ["type", "default"], ["color", "0", "0", "0", "0"]]
    kind = item[0]
    fill = lambda how: ["fill", ["type", how]]
    if kind in ("line", "area"):
        points = ["pts"] + [point("xy", x, y) for x, y in item[1]]
        return ["polyline", points, stroke, fill("outline" if kind == "area" else "none")]
    if kind == "box":
        (left, top), (right, bottom) = item[1]
        return ["rectangle", point("start", left, top), point("end", right, bottom), stroke, fill("background")]
    (x, y), radius = item[1]
    return ["circle", point("center", x, y), ["radius", radius * GRID], stroke, fill("none")]


def two_terminal(name, prefix, shapes, first="1", second="2", names=("~", "~")):
    """Pin 1 on top, pin 2 at the bottom."""
    pins = [(first, names[0], "passive", 0, -2, "up"), (second, names[1], "passive", 0, 2, "down")]
    return Symbol(name, prefix, shapes, pins)


def diode(name, bar):
    """Cathode on top, anode at the bottom."""
    shapes = [
        ("line", [(0, -1), (0, 1)]),
        ("area", [(-0.5, 0.5), (0.5, 0.5), (0, -0.5), (-0.5, 0.5)]),
        ("line", bar),
    ]
    return two_terminal(name, "D", shapes, "1", "2", ("K", "A"))


def transistor(name, kind, source, pins):
    """Gate on the left, drain and source on the right, the source above or below."""
    shapes = [
        ("line", [(-1, 0), (-0.1, 0)]),
        ("line", [(-0.1, -0.7), (-0.1, 0.7)]),
        ("line", [(0.15, -0.75), (0.15, -0.35)]),
        ("line", [(0.15, -0.2), (0.15, 0.2)]),
        ("line", [(0.15, 0.35), (0.15, 0.75)]),
        ("line", [(0.15, -0.55), (1, -0.55), (1, -1)]),
        ("line", [(0.15, 0.55), (1, 0.55), (1, 1)]),
        ("line", [(0.15, 0), (0.6, 0), (0.6, 0.55 if source == "below" else -0.55)]),
        ("area", [(0.2, 0), (0.45, -0.12), (0.45, 0.12), (0.2, 0)] if kind == "n"
         else [(0.6, 0), (0.35, -0.12), (0.35, 0.12), (0.6, 0)]),
        ("circle", ((0.35, 0), 1.15)),
    ]
    return Symbol(name, "Q", shapes, pins, labels=((1.8, -0.4), (1.8, 0.4)))


def connector(name, pins, side="right", width=3):
    """A box with its pins below each other; `pins` are (number, name)."""
    height = len(pins)
    left, right = -width / 2, width / 2
    edge = right + 1 if side == "right" else left - 1
    shapes = [("box", ((left, -0.8), (right, height - 0.2)))]
    made = [(number, label, "passive", edge, row, side) for row, (number, label) in enumerate(pins)]
    at = ((left, -1.7), (left, -1.1))
    return Symbol(name, "J", shapes, made, numbers=True, names=True, labels=at)


def header(name, count, width=4):
    """A box with odd pins on the left and even pins on the right."""
    rows = count // 2
    shapes = [("box", ((-width / 2, -0.8), (width / 2, rows - 0.2)))]
    pins = []
    for row in range(rows):
        pins.append((2 * row + 1, "~", "passive", -width / 2 - 1, row, "left"))
        pins.append((2 * row + 2, "~", "passive", width / 2 + 1, row, "right"))
    return Symbol(name, "J", shapes, pins, numbers=True, labels=((-2, -1.7), (-2, -1.1)))


def buffer(name, output_kind, mark):
    shapes = [("line", [(-1, -1), (-1, 1), (1, 0), (-1, -1)])] + mark
    pins = [
        (2, "A", "input", -2, 0, "left"),
        (4, "Y", output_kind, 2, 0, "right"),
        (5, "VCC", "power_in", 0, -2, "up", 1.5),
        (3, "GND", "power_in", 0, 2, "down", 1.5),
    ]
    return Symbol(name, "U", shapes, pins, numbers=True, labels=((0.7, -1.4), (0.7, 1.4)))


def rail(name, down=False):
    """A supply's symbol: one hidden pin at the origin."""
    lines = [("line", [(0, 0), (0, 0.5)]), ("line", [(-0.5, 0.5), (0.5, 0.5)]), ("line", [(-0.25, 0.75), (0.25, 0.75)])]
    if not down:
        lines = [("line", [(0, 0), (0, -0.5)]), ("line", [(-0.4, -0.5), (0.4, -0.5)])]
    where = (0, 1.3) if down else (0, -1.0)
    pins = [(1, name, "power_symbol", 0, 0, "up" if down else "down")]
    return Symbol(name, "#PWR", lines, pins, labels=((0, 2), where), power=True)


HYSTERESIS = [("line", [(-0.75, 0.2), (-0.45, 0.2), (-0.45, -0.2)]), ("line", [(-0.6, 0.2), (-0.6, -0.2), (-0.3, -0.2)])]
OPEN_DRAIN = [("line", [(-0.6, 0), (-0.45, -0.2), (-0.3, 0), (-0.45, 0.2), (-0.6, 0)]), ("line", [(-0.6, 0.3), (-0.3, 0.3)])]
FET3 = [("1", "G", "input", -2, 0, "left"), ("3", "D", "passive", 1, -2, "up"), ("2", "S", "passive", 1, 2, "down")]
# With the source on top, as a high-side switch is drawn.
PFET3 = [("1", "G", "input", -2, 0, "left"), ("2", "S", "passive", 1, -2, "up"), ("3", "D", "passive", 1, 2, "down")]


def pfet8(source, source_side, drain, drain_side):
    """A P-MOSFET in SO-8, whose sources and drains lie over each other."""
    pins = [("4", "G", "input", -2, 0, "left")]
    pins += [(str(n), "S", "passive", 1, source, source_side, None, n > 1) for n in (1, 2, 3)]
    return pins + [(str(n), "D", "passive", 1, drain, drain_side, None, n > 5) for n in (5, 6, 7, 8)]


def library():
    """All symbols by name."""
    made = [
        two_terminal("R", "R", [("box", ((-0.4, -1), (0.4, 1)))]),
        two_terminal("C", "C", [
            ("line", [(0, -1), (0, -0.2)]), ("line", [(-0.8, -0.2), (0.8, -0.2)]),
            ("line", [(-0.8, 0.2), (0.8, 0.2)]), ("line", [(0, 0.2), (0, 1)])]),
        two_terminal("C_POLARIZED", "C", [
            ("line", [(0, -1), (0, -0.2)]), ("box", ((-0.8, -0.3), (0.8, -0.1))), ("line", [(-0.7, -0.8), (-0.3, -0.8)]),
            ("line", [(-0.5, -1), (-0.5, -0.6)]), ("line", [(-0.8, 0.2), (0.8, 0.2)]), ("line", [(0, 0.2), (0, 1)])]),
        two_terminal("L", "L", [("line", [
            (0, -1), (0.5, -0.9), (0.5, -0.6), (0, -0.5), (0.5, -0.4), (0.5, -0.1), (0, 0), (0.5, 0.1), (0.5, 0.4),
            (0, 0.5), (0.5, 0.6), (0.5, 0.9), (0, 1)])]),
        two_terminal("FUSE", "F", [("box", ((-0.4, -1), (0.4, 1))), ("line", [(0, -1), (0, 1)])]),
        diode("ZENER", [(-0.7, -0.3), (-0.5, -0.5), (0.5, -0.5), (0.7, -0.7)]),
        diode("TVS", [(-0.7, -0.2), (-0.5, -0.5), (0.5, -0.5), (0.7, -0.8)]),
        transistor("NMOS", "n", "below", FET3),
        transistor("PMOS", "p", "above", PFET3),
        transistor("PMOS_SO8", "p", "above", pfet8(-2, "up", 2, "down")),
        transistor("PMOS_SO8_REVERSE", "p", "below", pfet8(2, "down", -2, "up")),
        Symbol("PNP_PAIR", "Q", [
            ("box", ((-2, -1.8), (2, 1.8)))],
            [("1", "E1", "passive", -3, -1, "left"), ("2", "B1", "passive", -3, 0, "left"), ("6", "C1", "passive", -3, 1, "left"),
             ("4", "E2", "passive", 3, -1, "right"), ("5", "B2", "passive", 3, 0, "right"), ("3", "C2", "passive", 3, 1, "right")],
            numbers=True, names=True, labels=((-2, -2.7), (-2, -2.1))),
        Symbol("BUCK_FIXED", "U", [("box", ((-3, -2), (3, 2)))],
            [("3", "VIN", "power_in", -4, -1, "left"), ("2", "EN", "input", -4, 1, "left"), ("4", "GND", "power_in", 0, 3, "down"),
             ("6", "BST", "passive", 4, -1, "right"), ("5", "SW", "passive", 4, 0, "right"), ("1", "FB", "input", 4, 1, "right")],
            numbers=True, names=True, labels=((-3, -2.9), (-3, -2.3))),
        buffer("BUFFER_OPEN_DRAIN", "open_collector", OPEN_DRAIN),
        buffer("BUFFER_SCHMITT", "output", HYSTERESIS),
        connector("BATTERY", [(1, "+"), (2, "-")]),
        connector("MAIN_POWER_OUT", [(1, "+"), (2, "-")], "left"),
        connector("MAIN_BOARD", [(n, name) for n, name in enumerate(
            ["LED 3 / RXD", "+5 V", "GND", "button 3 / TXD", "OK LED", "LED ?", "button 2", "button 1", "LED 2", "LED 1"], 1)], width=7),
        connector("BUTTON_BOARD", [(n, name) for n, name in enumerate(
            ["LED 3", "+5 V", "GND", "button 3", "OK LED", "LED ?", "button 2", "button 1", "LED 2", "LED 1"], 1)], width=5),
        connector("IMU_SOCKET", [(n, name) for n, name in enumerate(
            ["VCC", "GND", "SCL", "SDA", "XDA", "XCL", "AD0", "INT"], 1)], "left", width=4),
        connector("QWIIC", [(1, "GND"), (2, "3.3 V"), (3, "SDA"), (4, "SCL"), ("MP", "shell")], "left", width=4),
        header("PI_HEADER", 40),
        Symbol("TEST_PAD", "TP", [("circle", ((0, -0.4), 0.4))], [(1, "1", "passive", 0, 1, "down")],
               labels=((0, -1.6), (0, -1.0))),
        Symbol("HOLE", "H", [("circle", ((0, 0), 0.6))], [], labels=((1, -0.3), (1, 0.4))),
        rail("GND", down=True), rail("+3V3"), rail("+5V"), rail("+5VP"), rail("VBAT"),
    ]
    flag = Symbol("PWR_FLAG", "#FLG", [("line", [(0, 0), (0, -0.5), (-0.4, -0.8), (0, -1.1), (0.4, -0.8), (0, -0.5)])],
                  [(1, "pwr", "power_out", 0, 0, "down", 0)], labels=((0, 1), (0, -1.5)), power=True)
    return {symbol.name: symbol for symbol in made + [flag]}

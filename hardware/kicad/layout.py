"""Draws the board: footprints of KiCad's library with their nets, tracks of the router, zones, outline, texts."""

from expression import Text, child, children, identifier, parse
from router import Pad, Router
from sheet import TURN

FOOTPRINTS = "/usr/share/kicad/footprints"
ORIGIN = (50.0, 50.0)
LAYERS = [
    (0, "F.Cu", "signal"), (31, "B.Cu", "signal"), (34, "B.Paste", "user"), (35, "F.Paste", "user"), (36, "B.SilkS", "user"),
    (37, "F.SilkS", "user"), (38, "B.Mask", "user"), (39, "F.Mask", "user"), (44, "Edge.Cuts", "user"), (45, "Margin", "user"),
    (46, "B.CrtYd", "user"), (47, "F.CrtYd", "user"), (48, "B.Fab", "user"), (49, "F.Fab", "user"),
]
TEXT_HEIGHT = 0.8


class Board:
    def __init__(self, design):
        self.design = design
        names = sorted({design.board_net(net) for part in design.parts for net in part.nets.values()})
        self.numbers = {"": 0}
        self.numbers.update({name: index for index, name in enumerate(names, 1)})
        self.pads, self.holes, self.boxes = [], [], []

    def draw(self):
        loaded = [(part, load(part.footprint)) for part in self.design.parts]
        for part, module in loaded:
            self.collect(part, module)
        zones = [(zone.net, zone.outline) for zone in self.design.zones]
        router = Router(self.design.size, self.pads, self.holes, zones, self.design.wide)
        router.run()
        made = self.head()
        made += [self.footprint(part, module) for part, module in loaded]
        made += self.outline() + [self.text(*mark) for mark in self.design.marks]
        made += self.tracks(router)
        made += self.planes()
        return made

    def head(self):
        made = ["kicad_pcb", ["version", "20211014"], ["generator", "pcbnew"], ["general", ["thickness", "1.6"]], ["paper", Text("A4")]]
        made.append(["title_block", ["title", Text(self.design.title)], ["date", Text(self.design.date)],
                     ["rev", Text(self.design.revision)], ["company", Text("LibreRVAC")]])
        made.append(["layers"] + [[str(number), Text(name), kind] for number, name, kind in LAYERS])
        made.append(["setup", ["pad_to_mask_clearance", "0"]])
        return made + [["net", str(number), Text(name)] for name, number in sorted(self.numbers.items(), key=lambda item: item[1])]

    def net(self, part, pad):
        net = part.nets.get(pad)
        name = self.design.board_net(net) if net else ""
        return ["net", str(self.numbers[name]), Text(name)]

    def collect(self, part, module):
        """Tells the router and the texts of all copper and holes."""
        x, y, angle = part.board
        for pad in children(module, "pad"):
            place, size = child(pad, "at"), child(pad, "size")
            dx, dy = TURN[angle](float(place[1]), float(place[2]))
            own = (float(place[3]) if len(place) > 3 else 0) + angle
            width, height = float(size[1]), float(size[2])
            if own % 180 == 90:
                width, height = height, width
            if pad[2] == "np_thru_hole":
                self.holes.append((x + dx, y + dy, width / 2))
            layers = (0, 1) if pad[2] == "thru_hole" else (0,)
            if pad[2] != "np_thru_hole":
                net = part.nets.get(str(pad[1])) or f"nothing at {part.reference}.{pad[1]}"
                self.pads.append(Pad(net, x + dx, y + dy, width / 2, height / 2, layers))
            self.boxes.append((x + dx - width / 2, y + dy - height / 2, x + dx + width / 2, y + dy + height / 2))
        for line in children(module, "fp_line"):
            if child(line, "layer")[1] == "F.SilkS":
                ends = [TURN[angle](float(child(line, key)[1]), float(child(line, key)[2])) for key in ("start", "end")]
                xs, ys = [x + end[0] for end in ends], [y + end[1] for end in ends]
                self.boxes.append((min(xs) - 0.1, min(ys) - 0.1, max(xs) + 0.1, max(ys) + 0.1))

    def footprint(self, part, module):
        x, y, angle = part.board
        symbol = identifier("symbol", part.reference)
        made = ["footprint", Text(part.footprint), ["layer", Text("F.Cu")], stamp("footprint", part.reference), position(x, y, angle)]
        made += [["descr", Text(part.what)], ["property", Text("MPN"), Text(part.number)], ["property", Text("Manufacturer"), Text(part.maker)]]
        made.append(["path", Text(f"/{symbol}")])
        attributes = list(child(module, "attr") or ["attr"])
        if not part.bought or not part.fitted:
            attributes += [word for word in ("exclude_from_pos_files", "exclude_from_bom") if word not in attributes]
        made.append(attributes)
        for index, item in enumerate(module[2:]):
            if not isinstance(item, list) or item[0] not in ("fp_text", "fp_line", "fp_circle", "fp_arc", "fp_poly", "fp_rect", "pad"):
                continue
            item = [entry for entry in item if not (isinstance(entry, list) and entry[0] == "tstamp")]
            if item[0] == "pad":
                item = turn(item, angle) + [self.net(part, str(item[1]))] if item[2] != "np_thru_hole" else turn(item, angle)
            elif item[0] == "fp_text":
                item = self.footprint_text(part, item, angle)
            if item:
                made.append(item + [stamp("item", part.reference, index)])
        return made

    def footprint_text(self, part, item, angle):
        if item[1] == "value":
            item[2] = Text(part.value)
            return turn(item, angle)
        if item[1] == "reference":
            return self.reference(part, angle)
        return turn(item, angle)

    def reference(self, part, angle):
        """The reference on the silk screen, at the first side of the part where it covers nothing."""
        x, y, _ = part.board
        own = [pad for pad in self.extents(part)]
        left, top, right, bottom = min(b[0] for b in own), min(b[1] for b in own), max(b[2] for b in own), max(b[3] for b in own)
        half, gap = len(part.reference) * 0.36 + 0.1, 0.65
        middle_x, middle_y = (left + right) / 2, (top + bottom) / 2
        spots = [(middle_x, top - gap), (middle_x, bottom + gap), (left - half - 0.25, middle_y), (right + half + 0.25, middle_y),
                 (left + half, top - gap), (right - half, top - gap), (left + half, bottom + gap), (right - half, bottom + gap),
                 (middle_x, top - gap - 0.45), (middle_x, bottom + gap + 0.45)]
        layer, spot = "F.Fab", (middle_x, middle_y)
        for place in spots:
            box = (place[0] - half, place[1] - 0.5, place[0] + half, place[1] + 0.5)
            if self.is_free(box):
                layer, spot = "F.SilkS", place
                self.boxes.append(box)
                break
        dx, dy = TURN[(360 - angle) % 360](spot[0] - x, spot[1] - y)
        return ["fp_text", "reference", Text(part.reference), ["at", dx, dy, 0], ["layer", Text(layer)], effects(TEXT_HEIGHT)]

    def extents(self, part):
        module = load(part.footprint)
        x, y, angle = part.board
        found = []
        for line in children(module, "fp_line") + children(module, "fp_circle"):
            if child(line, "layer")[1] not in ("F.SilkS", "F.Fab"):
                continue
            ends = [child(line, key) for key in ("start", "end", "center") if child(line, key)]
            points = [TURN[angle](float(end[1]), float(end[2])) for end in ends]
            found += [(x + px, y + py, x + px, y + py) for px, py in points]
        for pad in children(module, "pad"):
            place, size = child(pad, "at"), child(pad, "size")
            dx, dy = TURN[angle](float(place[1]), float(place[2]))
            width, height = float(size[1]) / 2, float(size[2]) / 2
            if angle in (90, 270):
                width, height = height, width
            found.append((x + dx - width, y + dy - height, x + dx + width, y + dy + height))
        return found

    def is_free(self, box):
        width, height = self.design.size
        if box[0] < 0.5 or box[1] < 0.5 or box[2] > width - 0.5 or box[3] > height - 0.5:
            return False
        for mark, x, y, size in self.design.marks:
            if overlap(box, (x - len(mark) * size * 0.5, y - size, x + len(mark) * size * 0.5, y + size)):
                return False
        return not any(overlap(box, other) for other in self.boxes)

    def outline(self):
        width, height = self.design.size
        corners = [(0, 0), (width, 0), (width, height), (0, height)]
        made = []
        for begin, end in zip(corners, corners[1:] + corners[:1]):
            made.append(["gr_line", moved("start", *begin), moved("end", *end), ["layer", Text("Edge.Cuts")], ["width", 0.1],
                         stamp("edge", *begin)])
        return made

    def text(self, words, x, y, size):
        return ["gr_text", Text(words), position(x, y, 0), ["layer", Text("F.SilkS")], stamp("text", words), effects(size)]

    def tracks(self, router):
        segments, vias = router.copper()
        made = []
        for net, layer, begin, end, width in segments:
            name = Text("B.Cu" if layer else "F.Cu")
            number = str(self.numbers[self.design.board_net(net)])
            made.append(["segment", moved("start", *begin), moved("end", *end), ["width", width], ["layer", name], ["net", number],
                         stamp("track", net, layer, *begin, *end)])
        vias += [("GND", x, y) for x, y in router.stitches(4.0)]
        for net, x, y in vias:
            number = str(self.numbers[self.design.board_net(net)])
            made.append(["via", position(x, y), ["size", 0.6], ["drill", 0.3], ["layers", Text("F.Cu"), Text("B.Cu")], ["net", number],
                         stamp("via", net, x, y)])
        return made

    def planes(self):
        width, height = self.design.size
        whole = [(0.3, 0.3), (width - 0.3, 0.3), (width - 0.3, height - 0.3), (0.3, height - 0.3)]
        made = [self.zone("GND", layer, whole, 0) for layer in ("F.Cu", "B.Cu")]
        return made + [self.zone(zone.net, "F.Cu", zone.outline, 1) for zone in self.design.zones]

    def zone(self, net, layer, outline, priority):
        name = self.design.board_net(net)
        made = ["zone", ["net", str(self.numbers[name])], ["net_name", Text(name)], ["layer", Text(layer)], stamp("zone", net, layer),
                ["hatch", "edge", 0.5]]
        if priority:
            made.append(["priority", str(priority)])
        # Supplies join their pads without gaps, for the current; ground keeps gaps, for the soldering iron.
        connect = ["connect_pads", "yes", ["clearance", 0.25]] if priority else ["connect_pads", ["clearance", 0.25]]
        made += [connect, ["min_thickness", 0.25], ["filled_areas_thickness", "no"]]
        made.append(["fill", "yes", ["thermal_gap", 0.25], ["thermal_bridge_width", 0.4]])
        made.append(["polygon", ["pts"] + [moved("xy", *point) for point in outline]])
        return made


def load(footprint):
    library, name = footprint.split(":")
    with open(f"{FOOTPRINTS}/{library}.pretty/{name}.kicad_mod", encoding="utf-8") as file:
        return parse(file.read())


def turn(item, angle):
    """Angles inside of a footprint are those on the board."""
    made = []
    for entry in item:
        if isinstance(entry, list) and entry[0] == "at" and angle:
            own = next((float(word) for word in entry[3:] if word != "unlocked"), 0)
            entry = entry[:3] + [(own + angle) % 360]
        made.append(entry)
    return made


def overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def effects(size):
    return ["effects", ["font", ["size", size, size], ["thickness", size * 0.15]]]


def stamp(*names):
    return ["tstamp", identifier("board", *names)]


def moved(name, x, y):
    return [name, x + ORIGIN[0], y + ORIGIN[1]]


def position(x, y, angle=None):
    made = moved("at", x, y)
    return made if angle is None else made + [angle]

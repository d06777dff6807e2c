"""Routes a two-layer board on a grid: negotiated congestion over A* searches, the same result in every run.

Each net may cross others at a price that grows until nobody crosses any more. Two widths exist. Lengths are in mm from the
board's upper left corner; layer 0 is the upper side.
"""

import heapq
from math import hypot

CELL = 0.25
CLEARANCE = 0.21
HALF_WIDTH = (0.125, 0.25)
VIA_RADIUS, VIA_COST = 0.3, 14
EDGE = 0.4
FOREIGN_ZONE_COST = 12
STEPS = [(dx, dy, hypot(dx, dy)) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if dx or dy]
HARD = -2


class Pad:
    """Copper of a part: centre, half extents (already turned), layers, net, and a hole's radius."""

    def __init__(self, net, x, y, half_x, half_y, layers):
        self.net, self.x, self.y, self.half_x, self.half_y, self.layers = net, x, y, half_x, half_y, layers

    def distance(self, x, y):
        return hypot(max(abs(x - self.x) - self.half_x, 0), max(abs(y - self.y) - self.half_y, 0))


def disc(radius):
    reach = int(radius / CELL) + 1
    cells = range(-reach, reach + 1)
    return [(dx, dy) for dx in cells for dy in cells if hypot(dx, dy) * CELL < radius - 1e-9]


class Router:
    def __init__(self, size, pads, holes, zones, wide):
        self.columns, self.rows = int(size[0] / CELL) + 1, int(size[1] / CELL) + 1
        self.size, self.pads, self.holes, self.zones, self.wide = size, pads, holes, zones, set(wide)
        count = self.columns * self.rows
        # Whose clearance a cell lies in: None nobody's, a net, or HARD; by width class and layer, and for vias.
        self.owner = [[[None] * count for _ in (0, 1)] for _ in HALF_WIDTH]
        self.via_owner = [None] * count
        self.zone_of = [None] * count
        self.use = [[[0] * count for _ in (0, 1)] for _ in HALF_WIDTH]
        self.via_use = [0] * count
        self.history = [[0.0] * count for _ in (0, 1)]
        self.routes = {}
        self.discs = {}
        self.block()

    def index(self, column, row):
        return row * self.columns + column

    def block(self):
        for pad in self.pads:
            for width, half in enumerate(HALF_WIDTH):
                for layer in pad.layers:
                    self.claim(self.owner[width][layer], pad, half + CLEARANCE)
            self.claim(self.via_owner, pad, VIA_RADIUS + CLEARANCE)
        for x, y, radius in self.holes:
            hole = Pad(HARD, x, y, 0, 0, (0, 1))
            for width, half in enumerate(HALF_WIDTH):
                for layer in (0, 1):
                    self.claim(self.owner[width][layer], hole, radius + half + 0.3)
            self.claim(self.via_owner, hole, radius + VIA_RADIUS + 0.3)
        self.block_edge()
        for net, outline in self.zones:
            for row in range(self.rows):
                for column in range(self.columns):
                    if inside(outline, column * CELL, row * CELL):
                        self.zone_of[self.index(column, row)] = net

    def block_edge(self):
        width, height = self.size
        for row in range(self.rows):
            for column in range(self.columns):
                x, y = column * CELL, row * CELL
                margin = min(x, y, width - x, height - y)
                at = self.index(column, row)
                for kind, half in enumerate(HALF_WIDTH):
                    if margin < half + EDGE:
                        self.owner[kind][0][at] = self.owner[kind][1][at] = HARD
                if margin < VIA_RADIUS + EDGE:
                    self.via_owner[at] = HARD

    def claim(self, owners, pad, reach):
        for column, row in self.around(pad, reach):
            if pad.distance(column * CELL, row * CELL) < reach:
                at = self.index(column, row)
                owners[at] = pad.net if owners[at] in (None, pad.net) else HARD

    def around(self, pad, reach):
        left, right = int((pad.x - pad.half_x - reach) / CELL), int((pad.x + pad.half_x + reach) / CELL) + 1
        top, bottom = int((pad.y - pad.half_y - reach) / CELL), int((pad.y + pad.half_y + reach) / CELL) + 1
        for row in range(max(top, 0), min(bottom, self.rows - 1) + 1):
            for column in range(max(left, 0), min(right, self.columns - 1) + 1):
                yield column, row

    def width_class(self, net):
        return 1 if net in self.wide else 0

    def cells_of(self, pad):
        """Cells inside the pad, or the one next to its centre."""
        cells = [self.index(c, r) for c, r in self.around(pad, 0) if pad.distance(c * CELL, r * CELL) <= 0]
        return cells or [self.index(round(pad.x / CELL), round(pad.y / CELL))]

    def run(self, rounds=40):
        nets = {}
        for pad in self.pads:
            if pad.net not in (None, HARD, "GND"):
                nets.setdefault(pad.net, []).append(pad)
        self.fan_out_ground()
        order = sorted((net for net in nets if len(nets[net]) > 1), key=lambda net: (self.extent(nets[net]), net))
        price = 1.0
        for turn in range(rounds):
            for net in order:
                if turn and not self.crossed(net):
                    continue
                self.tear(net)
                self.route(net, nets[net], price)
            crossed = [net for net in order if self.crossed(net)]
            print(f"round {turn + 1}: {len(crossed)} nets cross: {' '.join(crossed[:8])}", flush=True)
            if not crossed:
                return
            self.remember(crossed)
            price *= 1.6
        raise SystemExit("the board cannot be routed")

    @staticmethod
    def extent(pads):
        xs, ys = [pad.x for pad in pads], [pad.y for pad in pads]
        return round(max(xs) - min(xs) + max(ys) - min(ys), 3)

    def groups(self, net, pads):
        """What must be joined: each pad, and all pads of a zone together with the zone."""
        zone_cells = [at for at, owner in enumerate(self.zone_of) if owner == net]
        free = [at for at in zone_cells if self.owner[self.width_class(net)][0][at] in (None, net)]
        joined, single = [], []
        for pad in pads:
            touches = 0 in pad.layers and any(self.zone_of[at] == net for at in self.cells_of(pad))
            (joined if touches else single).append(pad)
        groups = [{(layer, at) for at in self.cells_of(pad) for layer in pad.layers} for pad in single]
        if joined:
            groups.append({(0, at) for at in free} | {(layer, at) for pad in joined for at in self.cells_of(pad) for layer in pad.layers})
        return groups

    def route(self, net, pads, price):
        groups = self.groups(net, pads)
        groups.sort(key=lambda cells: min(cells))
        tree = groups.pop(max(range(len(groups)), key=lambda i: len(groups[i])))
        paths = []
        while groups:
            path = self.search(net, tree, set().union(*groups), price)
            if path is None:
                raise SystemExit(f"{net} has no way")
            end = path[-1]
            reached = next(cells for cells in groups if end in cells)
            groups.remove(reached)
            tree = tree | reached | set(path)
            paths.append(path)
        self.routes[net] = paths
        self.stamp(net, paths, 1)

    def search(self, net, sources, targets, price):
        kind = self.width_class(net)
        columns = self.columns
        spots = [(at % columns, at // columns) for _, at in targets]
        left, right = min(c for c, _ in spots), max(c for c, _ in spots)
        top, bottom = min(r for _, r in spots), max(r for _, r in spots)

        def ahead(at):
            dx, dy = at % columns, at // columns
            return hypot(max(left - dx, dx - right, 0), max(top - dy, dy - bottom, 0))

        cost = {node: 0.0 for node in sources}
        came, queue = {}, [(ahead(node[1]), node) for node in sorted(sources)]
        heapq.heapify(queue)
        done = set()
        while queue:
            _, node = heapq.heappop(queue)
            if node in done:
                continue
            done.add(node)
            if node in targets:
                return trace(came, node)
            for step, length in self.neighbours(net, kind, node, price):
                total = cost[node] + length
                if total < cost.get(step, 1e18):
                    cost[step] = total
                    came[step] = node
                    heapq.heappush(queue, (total + ahead(step[1]), step))
        return None

    def neighbours(self, net, kind, node, price):
        layer, at = node
        column, row = at % self.columns, at // self.columns
        owner, use, history = self.owner[kind][layer], self.use[kind][layer], self.history[layer]
        for dx, dy, length in STEPS:
            if not (0 <= column + dx < self.columns and 0 <= row + dy < self.rows):
                continue
            to = at + dy * self.columns + dx
            if owner[to] is not None and owner[to] != net:
                continue
            factor = 1.0 + history[to] + price * use[to]
            if layer == 1:
                factor += 0.15
            elif self.zone_of[to] not in (None, net):
                factor += FOREIGN_ZONE_COST
            yield (layer, to), length * factor
        other = 1 - layer
        if self.via_owner[at] in (None, net) and self.owner[kind][other][at] in (None, net):
            crossing = price * 3 * self.via_use[at]
            foreign = FOREIGN_ZONE_COST * 4 if self.zone_of[at] not in (None, net) else 0
            yield (other, at), VIA_COST + crossing + foreign + self.history[other][at]

    def stamp(self, net, paths, amount):
        kind = self.width_class(net)
        for path in paths:
            for (layer, at), following in zip(path, path[1:] + [None]):
                for width, half in enumerate(HALF_WIDTH):
                    self.add(self.use[width][layer], at, HALF_WIDTH[kind] + half + CLEARANCE, amount)
                self.add(self.via_use, at, HALF_WIDTH[kind] + VIA_RADIUS + CLEARANCE, amount)
                if following and following[0] != layer:
                    self.stamp_via(at, amount)

    def stamp_via(self, at, amount):
        for width, half in enumerate(HALF_WIDTH):
            for layer in (0, 1):
                self.add(self.use[width][layer], at, VIA_RADIUS + half + CLEARANCE, amount)
        self.add(self.via_use, at, 2 * VIA_RADIUS + CLEARANCE, amount)

    def add(self, cells, at, radius, amount):
        column, row = at % self.columns, at // self.columns
        if radius not in self.discs:
            self.discs[radius] = disc(radius)
        for dx, dy in self.discs[radius]:
            if 0 <= column + dx < self.columns and 0 <= row + dy < self.rows:
                cells[at + dy * self.columns + dx] += amount

    def tear(self, net):
        if net in self.routes:
            self.stamp(net, self.routes.pop(net), -1)

    def crossings(self, net):
        """Cells of the net's own copper that lie in the clearance of another net's."""
        kind = self.width_class(net)
        paths = self.routes.get(net, [])
        self.stamp(net, paths, -1)
        found = []
        for path in paths:
            for (layer, at), following in zip(path, path[1:] + [None]):
                through = following and following[0] != layer
                if self.use[kind][layer][at] or (through and self.via_use[at]):
                    found.append((layer, at))
        self.stamp(net, paths, 1)
        return found

    def crossed(self, net):
        return bool(self.crossings(net))

    def remember(self, nets):
        for net in nets:
            for layer, at in self.crossings(net):
                self.history[layer][at] += 1.5

    def fan_out_ground(self):
        """Every pad of ground on one layer gets a way to a via, for good."""
        self.ground = []
        for pad in self.pads:
            if pad.net != "GND" or len(pad.layers) > 1:
                continue
            path = self.to_via(pad)
            if path is None:
                raise SystemExit(f"ground at {pad.x}, {pad.y} has no place for a via")
            self.ground.append((pad, path))
            self.stamp("GND", [path + [(1, path[-1][1])]], 1)
            for layer, at in path + [(1, path[-1][1])]:
                via = Pad("GND", at % self.columns * CELL, at // self.columns * CELL, 0, 0, (0, 1))
                reach = VIA_RADIUS if (layer, at) == path[-1] else HALF_WIDTH[0]
                for width, half in enumerate(HALF_WIDTH):
                    for side in ((0, 1) if reach == VIA_RADIUS else (0,)):
                        self.claim(self.owner[width][side], via, reach + half + CLEARANCE)
                self.claim(self.via_owner, via, reach + VIA_RADIUS + CLEARANCE)
            self.stamp("GND", [path + [(1, path[-1][1])]], -1)

    def to_via(self, pad):
        cost = {(0, at): 0.0 for at in self.cells_of(pad)}
        came, queue, done = {}, [(0.0, node) for node in sorted(cost)], set()
        while queue:
            total, node = heapq.heappop(queue)
            if node in done:
                continue
            done.add(node)
            at = node[1]
            x, y = at % self.columns * CELL, at // self.columns * CELL
            outside = pad.distance(x, y) >= VIA_RADIUS + 0.1
            if outside and self.via_owner[at] in (None, "GND") and self.owner[0][1][at] in (None, "GND") and self.zone_of[at] is None:
                return trace(came, node)
            for step, length in self.neighbours("GND", 0, node, 1.0):
                if step[0] == 0 and total + length < cost.get(step, 1e18) and total < 40:
                    cost[step] = total + length
                    came[step] = node
                    heapq.heappush(queue, (total + length, step))
        return None

    def stitches(self, spacing):
        """Places for vias that join the two ground planes, apart from each other and from all else."""
        reach, placed = int(spacing / CELL), []
        for row in range(reach // 2, self.rows, reach):
            for column in range(reach // 2, self.columns, reach):
                at = self.index(column, row)
                if self.via_owner[at] is None and not self.via_use[at] and self.zone_of[at] is None:
                    placed.append((column * CELL, row * CELL))
        return placed

    def copper(self):
        """Segments (net, layer, from, to, width) and vias (net, x, y)."""
        segments, vias = [], []
        for net in sorted(self.routes):
            for path in self.routes[net]:
                self.lay(net, path, segments, vias)
        for _, path in self.ground:
            self.lay("GND", path, segments, vias)
            vias.append(("GND",) + self.place(path[-1][1]))
        return segments, vias

    def place(self, at):
        return (at % self.columns * CELL, at // self.columns * CELL)

    def lay(self, net, path, segments, vias):
        width = 2 * HALF_WIDTH[self.width_class(net)]
        begin = path[0]
        for end in (path[0], path[-1]):
            self.into_pad(net, end, width, segments)
        for before, node, after in zip(path, path[1:], path[2:] + [None]):
            if node[0] != before[0]:
                vias.append((net,) + self.place(node[1]))
                begin = node
                continue
            straight = after and after[0] == node[0] and after[1] - node[1] == node[1] - before[1]
            if not straight:
                segments.append((net, node[0], self.place(begin[1]), self.place(node[1]), width))
                begin = node


    def into_pad(self, net, node, width, segments):
        """A path ends on the grid somewhere in a pad; KiCad wants it to end in the pad's middle."""
        x, y = self.place(node[1])
        for pad in self.pads:
            if pad.net == net and node[0] in pad.layers and pad.distance(x, y) < CELL and (pad.x, pad.y) != (x, y):
                segments.append((net, node[0], (x, y), (pad.x, pad.y), width))
                return


def trace(came, node):
    path = [node]
    while node in came:
        node = came[node]
        path.append(node)
    return path[::-1]


def inside(outline, x, y):
    found = False
    for (ax, ay), (bx, by) in zip(outline, outline[1:] + outline[:1]):
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            found = not found
    return found

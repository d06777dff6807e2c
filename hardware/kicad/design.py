"""What a design is made of: parts with their nets, where they stand on sheet and board, wires, zones.

A design module (such as relax-adapter/design.py) fills one `Design`; sheet.py and layout.py draw it.
"""

from dataclasses import dataclass, field


@dataclass
class Part:
    """One part. `sheet` is (x, y, angle) in grid units, `board` is (x, y, angle) in mm from the board's upper left corner."""

    reference: str
    symbol: str
    value: str
    nets: dict
    sheet: tuple
    board: tuple
    footprint: str
    maker: str = ""
    number: str = ""
    what: str = ""
    fitted: bool = True
    bought: bool = True


@dataclass
class Zone:
    """Copper of a net on the upper side, as a polygon in mm from the board's upper left corner."""

    net: str
    outline: list


@dataclass
class Design:
    """A whole board."""

    name: str
    title: str
    date: str
    revision: str
    size: tuple
    rails: dict
    parts: list = field(default_factory=list)
    wires: list = field(default_factory=list)
    labels: dict = field(default_factory=dict)
    flags: list = field(default_factory=list)
    notes: list = field(default_factory=list)
    zones: list = field(default_factory=list)
    marks: list = field(default_factory=list)
    wide: tuple = ()

    def part(self, reference):
        return next(part for part in self.parts if part.reference == reference)

    def board_net(self, net):
        """The net as KiCad names it: supplies are global, all others belong to the root sheet."""
        return net if net in self.rails else f"/{net}"

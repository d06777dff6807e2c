"""Draws a design: schematic, symbol library, board, list of parts. Usage: draw.py FOLDER"""

import csv
import importlib.util
import json
import sys
from pathlib import Path

from expression import dump
from layout import Board
from sheet import Sheet, library_file

PROJECT = {
    "board": {"design_settings": {"rules": {"min_clearance": 0.2, "min_track_width": 0.2, "min_via_diameter": 0.5,
                                             "min_through_hole_diameter": 0.3, "min_copper_edge_clearance": 0.3}}},
    "meta": {"version": 1},
    "net_settings": {"classes": [{"name": "Default", "clearance": 0.2, "track_width": 0.25, "via_diameter": 0.6, "via_drill": 0.3,
                                   "bus_width": 12.0, "wire_width": 6.0, "diff_pair_gap": 0.25, "diff_pair_via_gap": 0.25,
                                   "diff_pair_width": 0.2, "line_style": 0, "microvia_diameter": 0.3, "microvia_drill": 0.1,
                                   "pcb_color": "rgba(0, 0, 0, 0.000)", "schematic_color": "rgba(0, 0, 0, 0.000)"}]},
    "schematic": {"legacy_lib_dir": "", "legacy_lib_list": []},
    "sheets": [],
    "text_variables": {},
}


def load(folder):
    spec = importlib.util.spec_from_file_location("board_design", folder / "design.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.DESIGN


def parts_list(design, path):
    """One line for each kind of part."""
    kinds = {}
    for part in design.parts:
        if part.bought:
            key = (part.value, part.footprint.split(":")[1], part.maker, part.number, part.what, "yes" if part.fitted else "no")
            kinds.setdefault(key, []).append(part.reference)
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["references", "quantity", "value", "footprint", "manufacturer", "part number", "what", "fitted"])
        for (value, footprint, maker, number, what, fitted), references in kinds.items():
            table.writerow([" ".join(references), len(references), value, footprint, maker, number, what, fitted])


def main():
    folder = Path(sys.argv[1])
    design = load(folder)
    base = folder / design.name
    base.with_suffix(".kicad_sch").write_text(dump(Sheet(design).draw()) + "\n", encoding="utf-8")
    base.with_suffix(".kicad_sym").write_text(library_file(design), encoding="utf-8")
    (folder / "sym-lib-table").write_text(
        f'(sym_lib_table\n  (lib (name "{design.name}")(type "KiCad")(uri "${{KIPRJMOD}}/{design.name}.kicad_sym")(options "")(descr ""))\n)\n',
        encoding="utf-8")
    project = dict(PROJECT, meta={"filename": f"{design.name}.kicad_pro", "version": 1})
    base.with_suffix(".kicad_pro").write_text(json.dumps(project, indent=2) + "\n", encoding="utf-8")
    parts_list(design, folder / "bill-of-materials.csv")
    if "--sheet-only" not in sys.argv:
        base.with_suffix(".kicad_pcb").write_text(dump(Board(design).draw()) + "\n", encoding="utf-8")


main()

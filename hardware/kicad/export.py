"""Fills the zones of a board, checks it, and writes what a maker and a reader need. Usage: export.py BOARD OUTPUT

Runs under the Python that KiCad 6 belongs to. Prints what the design rule check found; ends with 1 when that is anything.
"""

import re
import sys
from pathlib import Path

import pcbnew

GERBERS = [
    (pcbnew.F_Cu, "F_Cu"), (pcbnew.B_Cu, "B_Cu"), (pcbnew.F_Paste, "F_Paste"), (pcbnew.F_SilkS, "F_Silkscreen"),
    (pcbnew.B_SilkS, "B_Silkscreen"), (pcbnew.F_Mask, "F_Mask"), (pcbnew.B_Mask, "B_Mask"), (pcbnew.Edge_Cuts, "Edge_Cuts"),
]


def fill(path):
    """Fills the zones and saves the board."""
    board = pcbnew.LoadBoard(str(path))
    pcbnew.ZONE_FILLER(board).Fill(board.Zones())
    pcbnew.SaveBoard(str(path), board)
    return pcbnew.LoadBoard(str(path))


def check(board, report):
    """The design rule check of KiCad, with every track reported; returns the number of findings."""
    pcbnew.WriteDRCReport(board, str(report), pcbnew.EDA_UNITS_MILLIMETRES, True)
    text = report.read_text(encoding="utf-8")
    # The day is no part of the result.
    text = re.sub(r"\*\* Created on .* \*\*\n", "", text)
    text = re.sub(r"\*\* Drc report for .* \*\*", f"** Drc report for {Path(board.GetFileName()).name} **", text)
    report.write_text(text, encoding="utf-8")
    found = re.findall(r"\*\* Found (\d+) (?:DRC violations|unconnected pads|Footprint errors)", text)
    print(text)
    if len(found) != 3:
        raise SystemExit("the report of the design rule check has another form than KiCad 6 writes")
    return sum(int(count) for count in found)


def plotter(board, folder):
    control = pcbnew.PLOT_CONTROLLER(board)
    options = control.GetPlotOptions()
    options.SetOutputDirectory(str(folder))
    options.SetPlotFrameRef(False)
    options.SetUseAuxOrigin(False)
    options.SetDrillMarksType(pcbnew.PCB_PLOT_PARAMS.NO_DRILL_SHAPE)
    return control, options


def gerbers(board, folder):
    control, options = plotter(board, folder)
    options.SetUseGerberProtelExtensions(False)
    options.SetUseGerberAttributes(True)
    options.SetUseGerberX2format(True)
    options.SetSubtractMaskFromSilk(True)
    for layer, name in GERBERS:
        control.SetLayer(layer)
        control.OpenPlotfile(name, pcbnew.PLOT_FORMAT_GERBER, name)
        control.PlotLayer()
    control.ClosePlot()
    drill = pcbnew.EXCELLON_WRITER(board)
    drill.SetOptions(False, False, pcbnew.wxPoint(0, 0), False)
    drill.SetFormat(True)
    drill.CreateDrillandMapFilesSet(str(folder), True, False)


def dates(folder):
    """The moment of writing is no part of a result: a file drawn twice is the same."""
    for path in sorted(folder.rglob("*")):
        if path.suffix in (".gbr", ".drl"):
            text = path.read_text(encoding="utf-8")
            text = re.sub(r"(%TF\.CreationDate,|; #@! TF\.CreationDate,)[^*\n]*", r"\g<1>2026-11-28T00:00:00+00:00", text)
            text = re.sub(r"G04 Created by KiCad \(PCBNEW ([^)]*)\) date [^*]*\*", r"G04 Created by KiCad (PCBNEW \1)*", text)
            text = re.sub(r"; DRILL file \{KiCad ([^}]*)\} date .*", r"; DRILL file {KiCad \1}", text)
            path.write_text(text, encoding="utf-8")


def main():
    path, output = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()
    (output / "gerber").mkdir(parents=True, exist_ok=True)
    board = fill(path)
    findings = check(board, output / "drc.txt")
    gerbers(board, output / "gerber")
    dates(output)
    sys.exit(1 if findings else 0)


main()

"""The adapter board of the Vileda Relax: parts, nets, places. README.md beside this file says why each value is what it is."""

from design import Design, Part, Zone

R0603 = "Resistor_SMD:R_0603_1608Metric"
C0603 = "Capacitor_SMD:C_0603_1608Metric"
C1206 = "Capacitor_SMD:C_1206_3216Metric"
SOT23 = "Package_TO_SOT_SMD:SOT-23"
SOT235 = "Package_TO_SOT_SMD:SOT-23-5"

RESISTORS = {
    "0": "RC0603JR-070RL", "100": "RC0603FR-07100RL", "330": "RC0603FR-07330RL", "1k": "RC0603FR-071KL",
    "2.2k": "RC0603FR-072K2L", "10k": "RC0603FR-0710KL", "22k": "RC0603FR-0722KL", "47k": "RC0603FR-0747KL",
    "100k": "RC0603FR-07100KL", "470k": "RC0603FR-07470KL",
}
CAPACITORS = {
    "100n": (C0603, "Samsung", "CL10B104KB8NNNC", "ceramic capacitor 100 nF 50 V X7R"),
    "10u 50V": ("Capacitor_SMD:C_1210_3225Metric", "Samsung", "CL32B106KBJNNNE", "ceramic capacitor 10 uF 50 V X7R"),
    "22u 16V": (C1206, "Samsung", "CL31A226KOHNNNE", "ceramic capacitor 22 uF 16 V X5R"),
}

DESIGN = Design(
    name="relax-adapter",
    title="Vileda Relax: adapter board",
    date="2026-11-28",
    revision="1",
    size=(126.0, 52.0),
    rails={"GND": "down", "+3V3": "up", "+5V": "up", "+5VP": "up", "VBAT": "up"},
    wide=("+3V3", "+5VP", "+5V", "VBAT", "BUCK_IN", "V5_BUCK", "MAIN_POWER"),
)


def add(reference, symbol, value, nets, sheet, board, footprint, maker, number, what, fitted=True, bought=True):
    # The pins in the order of their numbers, or named.
    if isinstance(nets, (list, tuple)):
        nets = {str(index): net for index, net in enumerate(nets, 1)}
    kept = {pin: net for pin, net in nets.items() if net}
    DESIGN.parts.append(Part(reference, symbol, value, kept, sheet, board, footprint, maker, number, what, fitted, bought))


def resistor(reference, value, first, second, sheet, board, fitted=True):
    shown = value if fitted else f"{value} DNF"
    add(reference, "R", shown, [first, second], sheet, board, R0603, "Yageo", RESISTORS[value], f"resistor {value} ohm 1 %", fitted)


def capacitor(reference, value, first, second, sheet, board):
    footprint, maker, number, what = CAPACITORS[value]
    add(reference, "C", value, [first, second], sheet, board, footprint, maker, number, what)


def n_fet(reference, gate, source, drain, sheet, board):
    add(reference, "NMOS", "AO3400A", [gate, source, drain], sheet, board, SOT23, "Alpha & Omega", "AO3400A", "N-MOSFET 30 V, logic level")


def p_fet(reference, gate, source, drain, sheet, board):
    add(reference, "PMOS", "DMG2305UX", [gate, source, drain], sheet, board, SOT23, "Diodes", "DMG2305UX-7", "P-MOSFET 20 V, logic level")


def p_fet_8(reference, gate, source, drain, sheet, board, symbol="PMOS_SO8"):
    nets = {"1": source, "2": source, "3": source, "4": gate, "5": drain, "6": drain, "7": drain, "8": drain}
    footprint = "Package_SO:SOIC-8_3.9x4.9mm_P1.27mm"
    add(reference, symbol, "DMP4015SSS", nets, sheet, board, footprint, "Diodes", "DMP4015SSS-13", "P-MOSFET 40 V, 11 mohm")


def diode(reference, symbol, value, footprint, number, what, cathode, anode, sheet, board):
    maker = "Littelfuse" if symbol == "TVS" else "Diodes"
    add(reference, symbol, value, [cathode, anode], sheet, board, footprint, maker, number, what)


def fuse(reference, value, number, first, second, sheet, board):
    footprint = "Fuse:Fuse_Littelfuse-NANO2-451_453"
    add(reference, "FUSE", value, [first, second], sheet, board, footprint, "Littelfuse", number, f"fuse {value}, slow")


def schmitt(reference, given, result, sheet, board):
    nets = {"2": given, "3": "GND", "4": result, "5": "+3V3"}
    add(reference, "BUFFER_SCHMITT", "SN74LVC1G17", nets, sheet, board, SOT235, "Texas Instruments", "SN74LVC1G17DBVR",
        "Schmitt buffer, input to 5.5 V, Ioff")


def zener(reference, cathode, anode, sheet, board):
    diode(reference, "ZENER", "BZT52C15", "Diode_SMD:D_SOD-123", "BZT52C15-7-F", "Zener diode 15 V", cathode, anode, sheet, board)


def wire(*stops):
    DESIGN.wires.append(stops)


def label(net, x, y, direction):
    DESIGN.labels[(x, y)] = (net, direction)


def note(text, x, y, size=2.0):
    DESIGN.notes.append((text, x, y, size))


def battery():
    note("Battery, protection, main-board switch", 8, 9)
    vh = "Connector_JST:JST_VH_B2P-VH_1x02_P3.96mm_Vertical"
    add("J1", "BATTERY", "BATTERY", ["BAT_IN", "GND"], (10, 14, 0), (11, 5.5, 0), vh, "JST", "B2P-VH(LF)(SN)", "header VH 2 pins, battery")
    fuse("F1", "5A", "0452005.MRL", "BAT_FUSED", "BAT_IN", (16, 14, 270), (11, 14.5, 90))
    wire("J1.1", "F1.2")
    label("BAT_IN", 14, 14, "up")
    p_fet_8("Q1", "REVERSE_GATE", "VBAT", "BAT_FUSED", (22, 15, 90), (11, 22, 90), "PMOS_SO8_REVERSE")
    zener("D1", "VBAT", "REVERSE_GATE", (27, 18, 0), (19.2, 19.5, 0))
    resistor("R1", "10k", "REVERSE_GATE", "GND", (22, 22, 0), (18.6, 17, 180))
    diode("D2", "TVS", "SMBJ20A", "Diode_SMD:D_SMB", "SMBJ20A", "TVS diode 20 V, 600 W", "VBAT", "GND", (32, 18, 0), (20.2, 24.5, 0))
    wire("F1.1", "Q1.5")
    label("BAT_FUSED", 19, 14, "up")
    wire("Q1.4", "R1.1")
    wire("D1.2", (22, 20))
    label("REVERSE_GATE", 22, 19, "left")
    wire("Q1.1", (36, 14))
    wire("D1.1", (27, 14))
    wire("D2.1", (32, 14))
    label("VBAT", 36, 14, "up")
    p_fet_8("Q2", "MAIN_GATE", "VBAT", "MAIN_POWER", (24, 34, 0), (11, 31.5, 270))
    resistor("R2", "22k", "VBAT", "MAIN_GATE", (19, 30, 0), (4.6, 25.8, 0))
    zener("D3", "VBAT", "MAIN_GATE", (14, 30, 0), (4.2, 28.6, 0))
    resistor("R3", "10k", "MAIN_GATE", "MAIN_PULL", (19, 38, 0), (4.6, 34, 0))
    capacitor("C8", "100n", "MAIN_GATE", "MAIN_POWER", (22, 38, 90), (4.6, 31.3, 0))
    wire("D3.1", (14, 27), (25, 27), "Q2.1")
    wire("R2.1", (19, 27))
    label("VBAT", 25, 27, "up")
    wire("D3.2", (14, 34), (19, 34), "Q2.4")
    wire("R2.2", "R3.1")
    wire("C8.1", (20, 38), (20, 34))
    wire("C8.2", (25, 38), "Q2.5")
    label("MAIN_GATE", 16, 34, "down")
    n_fet("Q3", "MAIN_PULL_GATE", "GND", "MAIN_PULL", (18, 44, 0), (4.6, 37.5, 0))
    wire("R3.2", "Q3.3")
    label("MAIN_PULL", 19, 41, "right")
    resistor("R4", "330", "MAIN_ENABLE", "MAIN_PULL_GATE", (11, 44, 90), (4.6, 40.3, 180))
    resistor("R5", "100k", "MAIN_PULL_GATE", "GND", (14, 47, 0), (4.6, 42.2, 0))
    wire("R4.2", "Q3.1")
    wire("R5.1", (14, 44))
    label("MAIN_PULL_GATE", 15, 44, "up")
    add("J6", "MAIN_POWER_OUT", "MAIN BOARD", ["MAIN_POWER", "GND"], (32, 38, 0), (14.96, 46, 180), vh, "JST", "B2P-VH(LF)(SN)", "header VH 2 pins, main board")
    wire((25, 38), "J6.1")
    label("MAIN_POWER", 28, 38, "up")


def supply():
    note("5 V for the Linux board", 44, 9)
    fuse("F2", "2A", "0452002.MRL", "VBAT", "BUCK_IN", (46, 14, 90), (20.6, 30, 0))
    add("C1", "C_POLARIZED", "100u 50V", ["BUCK_IN", "GND"], (50, 17, 0), (23.4, 39.6, 270), "Capacitor_SMD:CP_Elec_8x10", "Panasonic",
        "EEE-FK1H101P", "electrolytic capacitor 100 uF 50 V, 8 x 10.2 mm")
    capacitor("C2", "10u 50V", "BUCK_IN", "GND", (54, 17, 0), (29.5, 33.8, 0))
    capacitor("C3", "100n", "BUCK_IN", "GND", (58, 17, 0), (29.6, 36.4, 0))
    resistor("R6", "100k", "BUCK_IN", "BUCK_EN", (62, 17, 0), (26.2, 25.2, 180), fitted=False)
    resistor("R7", "10k", "BUCK_EN", "GND", (62, 22, 0), (26.2, 23.2, 0), fitted=False)
    nets = {"1": "V5_BUCK", "2": "BUCK_EN", "3": "BUCK_IN", "4": "GND", "5": "BUCK_SW", "6": "BUCK_BST"}
    add("U1", "BUCK_FIXED", "AP63205WU", nets, (70, 15, 0), (29.5, 30, 0), "Package_TO_SOT_SMD:TSOT-23-6", "Diodes", "AP63205WU-7",
        "buck converter 5 V 2 A")
    capacitor("C4", "100n", "BUCK_BST", "BUCK_SW", (77, 12, 0), (31.6, 26, 0))
    add("L1", "L", "4.7u", ["BUCK_SW", "V5_BUCK"], (81, 15, 90), (35.7, 30.2, 0), "Inductor_SMD:L_Bourns-SRN6028", "Bourns",
        "SRN6028-4R7Y", "inductor 4.7 uH, shielded")
    capacitor("C5", "22u 16V", "V5_BUCK", "GND", (87, 18, 0), (35.6, 35.4, 180))
    capacitor("C6", "22u 16V", "V5_BUCK", "GND", (92, 18, 0), (35.6, 38.1, 180))
    wire("F2.2", "U1.3")
    for pin, x in (("C1.1", 50), ("C2.1", 54), ("C3.1", 58), ("R6.1", 62)):
        wire(pin, (x, 14))
    label("BUCK_IN", 48, 14, "up")
    wire("R6.2", "R7.1")
    wire((62, 19), (65, 19), (65, 16), "U1.2")
    label("BUCK_EN", 62, 20, "left")
    wire("U1.6", (75, 14), (75, 10), "C4.1")
    label("BUCK_BST", 75, 10, "left")
    wire("U1.5", "L1.1")
    wire("C4.2", (77, 15))
    label("BUCK_SW", 78, 15, "down")
    wire("L1.2", (95, 15))
    wire("C5.1", (87, 15))
    wire("C6.1", (92, 15))
    wire("U1.1", (75, 16), (75, 24), (84, 24), (84, 15))
    label("V5_BUCK", 89, 15, "up")
    p_fet("Q4", "ORING_GATE", "+5V", "V5_BUCK", (98, 14, 270), (42.2, 34.5, 180))
    wire((95, 15), "Q4.3")
    nets = {"1": "V5_BUCK", "2": "ORING_BASE", "6": "ORING_BASE", "4": "+5V", "5": "ORING_BASE", "3": "ORING_GATE"}
    add("Q5", "PNP_PAIR", "BCM857BS", nets, (98, 25, 0), (41.6, 38.5, 0), "Package_TO_SOT_SMD:SOT-363_SC-70-6", "Nexperia", "BCM857BS,115",
        "matched PNP pair")
    resistor("R8", "10k", "ORING_BASE", "GND", (91, 29, 0), (45.2, 39, 0))
    resistor("R9", "47k", "ORING_GATE", "GND", (105, 29, 0), (45.2, 37.2, 0))
    capacitor("C7", "22u 16V", "+5V", "GND", (106, 18, 0), (47, 32.6, 0))
    wire("Q4.2", (106, 15))
    wire("C7.1", (106, 15))
    label("+5V", 106, 15, "up")
    wire("Q5.6", (91, 26), "R8.1")
    wire("Q5.2", (93, 25), (93, 26))
    label("ORING_BASE", 91, 26, "left")
    wire("Q5.3", (105, 26), "R9.1")
    label("ORING_GATE", 105, 26, "up")


def serial():
    note("Serial line: 3.3 V <-> 5 V, nothing flows back while the main board is off", 44, 32)
    add("J2", "MAIN_BOARD", "MAIN BOARD SIGNALS", {"1": "RXD_MCU", "2": "+5VP", "3": "GND", "4": "TXD_MCU"}, (48, 41, 0), (50, 47.6, 0),
        "Connector_JST:JST_XH_B10B-XH-A_1x10_P2.50mm_Vertical", "JST", "B10B-XH-A(LF)(SN)", "header XH 10 pins, main board")
    nets = {"2": "UART_TX", "3": "GND", "4": "RXD_DRIVE", "5": "+3V3"}
    add("U2", "BUFFER_OPEN_DRAIN", "SN74LVC1G07", nets, (76, 41, 180), (52.4, 37, 180), SOT235, "Texas Instruments", "SN74LVC1G07DBVR",
        "open-drain buffer, output to 5.5 V, Ioff")
    resistor("R11", "100", "RXD_DRIVE", "RXD_MCU", (68, 41, 270), (47.6, 41, 270))
    resistor("R10", "2.2k", "+5VP", "RXD_MCU", (62, 38, 0), (50, 41, 90))
    resistor("R14", "100k", "+3V3", "UART_TX", (81, 38, 0), (54.4, 33.8, 0))
    capacitor("C9", "100n", "+3V3", "GND", (87, 39, 0), (52.4, 40, 180))
    wire("J2.1", "R11.2")
    wire("R10.2", (62, 41))
    label("RXD_MCU", 56, 41, "up")
    wire("R11.1", "U2.4")
    label("RXD_DRIVE", 72, 41, "up")
    wire("U2.2", (83, 41))
    wire("R14.2", (81, 41))
    label("UART_TX", 83, 41, "right")
    resistor("R12", "1k", "TXD_MCU", "TXD_SENSE", (61, 48, 90), (57.5, 42.6, 90))
    resistor("R13", "470k", "TXD_SENSE", "GND", (66, 51, 0), (59.8, 42.6, 90))
    schmitt("U3", "TXD_SENSE", "TXD_CLEAN", (72, 48, 0), (57.9, 37, 0))
    resistor("R15", "330", "TXD_CLEAN", "UART_RX", (79, 48, 90), (58.6, 33.8, 0))
    capacitor("C10", "100n", "+3V3", "GND", (87, 48, 0), (57.9, 39.9, 0))
    wire("J2.4", (55, 44), (55, 48), "R12.1")
    label("TXD_MCU", 57, 48, "up")
    wire("R12.2", "U3.2")
    wire("R13.1", (66, 48))
    label("TXD_SENSE", 66, 48, "up")
    wire("U3.4", "R15.1")
    label("TXD_CLEAN", 75, 48, "up")
    label("UART_RX", 82, 48, "right")
    wire("R15.2", (82, 48))


def buttons():
    note("Buttons: any level from 0 to 5 V", 8, 58)
    resistor("R19", "0", "+3V3", "BUTTON_BIAS", (12, 69, 0), (78, 33.6, 0))
    resistor("R20", "0", "BUTTON_BIAS", "GND", (12, 75, 0), (78, 35.6, 180), fitted=False)
    wire("R19.2", "R20.1")
    label("BUTTON_BIAS", 12, 72, "right")
    for index in (1, 2, 3):
        y, row = 58 + 11 * index, 30 + 3.8 * index
        net = f"BUTTON_{index}"
        resistor(f"R{15 + index}", "47k", "BUTTON_BIAS", net, (23, y - 3, 0), (74.3, row, 180))
        resistor(f"R{20 + index}", "1k", net, f"{net}_IN", (28, y, 90), (70.9, row, 180))
        schmitt(f"U{3 + index}", f"{net}_IN", f"{net}_OUT", (36, y, 0), (66.9, row, 180))
        resistor(f"R{23 + index}", "330", f"{net}_OUT", f"PI_{net}", (43, y, 90), (62.9, row - 0.95, 180))
        capacitor(f"C{10 + index}", "100n", "+3V3", "GND", (56, y, 0), (62.9, row + 0.95, 180))
        wire(f"R{15 + index}.2", (23, y), f"R{20 + index}.1")
        label(net, 23, y, "left")
        wire(f"R{20 + index}.2", f"U{3 + index}.2")
        label(f"{net}_IN", 31, y, "up")
        wire(f"U{3 + index}.4", f"R{23 + index}.1")
        label(f"{net}_OUT", 39, y, "up")
        wire(f"R{23 + index}.2", (46, y))
        label(f"PI_{net}", 46, y, "right")


def lights():
    note("Lights: three pulled low, two switched to +5VP", 60, 58)
    xh = "Connector_JST:JST_XH_B10B-XH-A_1x10_P2.50mm_Vertical"
    nets = ["LED_3", "+5VP", "GND", "BUTTON_3", "LED_OK", "LED_UNKNOWN", "BUTTON_2", "BUTTON_1", "LED_2", "LED_1"]
    add("J3", "BUTTON_BOARD", "BUTTON BOARD", nets, (124, 64, 0), (80, 47.6, 0), xh, "JST", "B10B-XH-A(LF)(SN)", "header XH 10 pins, button board")
    for index, column in ((1, 106), (2, 101), (3, 82)):
        x, net = 44 + 20 * index, f"LED_{index}"
        resistor(f"R{26 + index}", "330", f"PI_{net}", f"{net}_GATE", (x, 65, 90), (column, 36.4, 0))
        resistor(f"R{29 + index}", "100k", f"{net}_GATE", "GND", (x + 3, 68, 0), (column, 38.4, 180))
        n_fet(f"Q{5 + index}", f"{net}_GATE", "GND", net, (x + 7, 65, 0), (column, 41.5, 90))
        wire(f"R{26 + index}.2", f"Q{5 + index}.1")
        wire(f"R{29 + index}.1", (x + 3, 65))
        label(f"{net}_GATE", x + 4, 65, "up")
    for index, name, column in ((0, "OK", 88), (1, "UNKNOWN", 94.6)):
        x, net = 64 + 30 * index, f"LED_{name}"
        resistor(f"R{33 + index}", "330", f"PI_{net}", f"{net}_GATE", (x, 88, 90), (column, 31.9, 0))
        resistor(f"R{35 + index}", "100k", f"{net}_GATE", "GND", (x + 3, 91, 0), (column, 33.8, 180))
        n_fet(f"Q{9 + index}", f"{net}_GATE", "GND", f"{net}_HIGH", (x + 7, 88, 0), (column, 36.6, 90))
        resistor(f"R{37 + index}", "100k", "+5VP", f"{net}_HIGH", (x + 8, 80, 0), (column, 39.4, 180))
        p_fet(f"Q{11 + index}", f"{net}_HIGH", "+5VP", net, (x + 14, 83, 0), (column, 42.3, 0))
        wire(f"R{33 + index}.2", f"Q{9 + index}.1")
        wire(f"R{35 + index}.1", (x + 3, 88))
        label(f"{net}_GATE", x + 4, 88, "up")
        wire(f"R{37 + index}.2", f"Q{9 + index}.3")
        wire((x + 8, 83), f"Q{11 + index}.1")
        label(f"{net}_HIGH", x + 8, 84, "left")


PI = {1: "+3V3", 17: "+3V3", 2: "+5V", 4: "+5V", 3: "SDA", 5: "SCL", 8: "UART_TX", 10: "UART_RX", 7: "PI_BUTTON_1",
      11: "PI_BUTTON_2", 13: "PI_BUTTON_3", 15: "PI_LED_1", 16: "PI_LED_2", 18: "PI_LED_3", 22: "MAIN_ENABLE",
      29: "PI_LED_OK", 31: "PI_LED_UNKNOWN", 36: "IMU_INT"}
PI.update({pin: "GND" for pin in (6, 9, 14, 20, 25, 30, 34, 39)})


def linux_board():
    note("Linux board: header of a Pi, turned over", 112, 9)
    add("J4", "PI_HEADER", "LINUX BOARD", {str(pin): net for pin, net in PI.items()}, (126, 15, 0), (48.37, 26.23, 90),
        "Connector_PinSocket_2.54mm:PinSocket_2x20_P2.54mm_Vertical", "Harwin", "M20-7832046", "socket 2x20, 8.5 mm")
    note("Gyro on the Linux board", 112, 39)
    add("J5", "IMU_SOCKET", "IMU", ["+3V3", "GND", "SCL", "SDA", None, None, "GND", "IMU_INT"], (126, 45, 0), (107.5, 9.5, 0),
        "Connector_PinSocket_2.54mm:PinSocket_1x08_P2.54mm_Vertical", "Harwin", "M20-7820846", "socket 1x8, for a GY-521 breakout")
    nets = {"1": "GND", "2": "+3V3", "3": "SDA", "4": "SCL", "MP": "GND"}
    add("J7", "QWIIC", "I2C", nets, (146, 45, 0), (122.4, 38, 90), "Connector_JST:JST_SH_SM04B-SRSS-TB_1x04-1MP_P1.00mm_Horizontal", "JST",
        "SM04B-SRSS-TB(LF)(SN)", "header SH 4 pins, I2C breakouts")
    capacitor("C14", "100n", "+3V3", "GND", (138, 54, 0), (111.2, 9.5, 0))


def pads_and_holes():
    note("Test pads", 12, 97)
    pads = [("VBAT", 22.2, 13), ("+5V", 36, 45.5), ("+3V3", 40, 45.5), ("GND", 36, 49), ("RXD_MCU", 44, 45.5), ("TXD_MCU", 44, 49),
            ("+5VP", 40, 49), ("MAIN_POWER", 20.5, 49), ("BUCK_EN", 31, 23.2)]
    for index, (net, x, y) in enumerate(pads, 1):
        add(f"TP{index}", "TEST_PAD", net, [net], (6 + 5.5 * index, 101, 0), (x, y, 0), "TestPoint:TestPoint_Pad_D1.5mm", "", "", "test pad", bought=False)
    for index, (x, y) in enumerate([(4, 4), (4, 48), (122, 4), (122, 48)], 1):
        add(f"H{index}", "HOLE", "M3", [], (60 + 4 * index, 103, 0), (x, y, 0), "MountingHole:MountingHole_3.2mm_M3", "", "", "hole", bought=False)
    for index, (x, y) in enumerate([(43.5, 4.5), (101.5, 4.5), (43.5, 27.5), (101.5, 27.5)], 5):
        add(f"H{index}", "HOLE", "M2.5", [], (60 + 4 * index, 103, 0), (x, y, 0), "MountingHole:MountingHole_2.7mm_M2.5", "", "", "hole", bought=False)
    for index, net in enumerate(["GND", "+3V3", "+5V", "+5VP", "VBAT", "BUCK_IN"]):
        DESIGN.flags.append((net, 100 + 4.5 * index, 103))


def copper():
    for net, outline in [
        ("BAT_IN", [(8.6, 3.6), (13, 3.6), (13, 13.8), (8.6, 13.8)]),
        ("BAT_FUSED", [(7.2, 15.2), (14.8, 15.2), (14.8, 20.8), (7.2, 20.8)]),
        ("VBAT", [(7, 23), (19.8, 23), (19.8, 31.8), (16.4, 31.8), (16.4, 30.4), (7, 30.4)]),
        ("MAIN_POWER", [(7.2, 32.6), (16.9, 32.6), (16.9, 47.6), (13, 47.6), (13, 43), (7.2, 43)]),
        ("BUCK_IN", [(21.6, 28.2), (24.8, 28.2), (24.8, 30.5), (29, 30.5), (29, 37.4), (26.4, 38.4), (21.6, 38.4)]),
        ("BUCK_SW", [(30, 29.7), (31.9, 29.7), (31.9, 25.4), (34.4, 25.4), (34.4, 33.2), (32.3, 33.2), (32.3, 30.3), (30, 30.3)]),
        ("V5_BUCK", [(37, 27.2), (39.4, 27.2), (39.4, 33.6), (41.9, 33.6), (41.9, 35.4), (38.4, 35.4), (38.4, 39.2), (36.1, 39.2), (36.1, 33.9), (37, 33.9)]),
        ("+5V", [(42.3, 31), (47, 30.9), (47, 27.8), (52, 27.8), (52, 30.4), (49, 31.2), (46.2, 34), (42.3, 34.2)]),
    ]:
        DESIGN.zones.append(Zone(net, outline))
    DESIGN.marks += [("LibreRVAC relax-adapter rev 1", 72, 21, 1.6), ("Linux board, turned over", 72, 12, 1.2), ("BATTERY + -", 25, 4, 1),
                     ("MAIN + -", 24, 46.8, 1), ("MAIN BOARD", 68.5, 43.9, 1), ("BUTTON BOARD", 112.5, 44.6, 1), ("IMU", 107.5, 6.6, 1), ("I2C", 117, 33, 1)]


for block in (battery, supply, serial, buttons, lights, linux_board, pads_and_holes, copper):
    block()

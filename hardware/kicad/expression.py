"""S-expressions as KiCad writes them: reading, writing, and identifiers that are the same in every run."""

import uuid

NAMESPACE = uuid.uuid5(uuid.NAMESPACE_DNS, "librervac.hardware")


class Text(str):
    """A string in quotation marks; plain `str` is a bare word."""


def identifier(*names):
    """A UUID made of names, so that files drawn twice are equal."""
    return str(uuid.uuid5(NAMESPACE, "/".join(str(name) for name in names)))


def parse(text):
    """Reads one expression as nested lists."""
    stack, at, end = [[]], 0, len(text)
    while at < end:
        letter = text[at]
        if letter in " \t\r\n":
            at += 1
        elif letter == "(":
            stack.append([])
            at += 1
        elif letter == ")":
            closed = stack.pop()
            stack[-1].append(closed)
            at += 1
        elif letter == '"':
            at += 1
            letters = []
            while text[at] != '"':
                if text[at] == "\\":
                    at += 1
                letters.append(text[at])
                at += 1
            stack[-1].append(Text("".join(letters)))
            at += 1
        else:
            begin = at
            while at < end and text[at] not in ' \t\r\n()"':
                at += 1
            stack[-1].append(text[begin:at])
    return stack[0][0]


def number(value):
    """A length as KiCad writes it: at most six digits behind the point, no trailing zeros."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def dump(node, depth=0):
    """Writes nested lists, short ones on one line."""
    if isinstance(node, Text):
        return '"' + node.replace("\\", "\\\\").replace('"', '\\"') + '"'
    if isinstance(node, (int, float)):
        return number(node)
    if not isinstance(node, list):
        return node
    line = "(" + " ".join(dump(child) for child in node) + ")"
    if len(line) <= 110 and "\n" not in line:
        return line
    pad = "\n" + "  " * (depth + 1)
    parts, open_line = [], True
    for child in node:
        text = dump(child, depth + 1)
        if isinstance(child, list):
            parts.append(pad + text)
            open_line = False
        else:
            parts.append((" " if parts else "") + text if open_line else pad + text)
    return "(" + "".join(parts) + "\n" + "  " * depth + ")"


def children(node, name):
    """All direct children with this head."""
    return [child for child in node if isinstance(child, list) and child and child[0] == name]


def child(node, name):
    """The first direct child with this head, or None."""
    found = children(node, name)
    return found[0] if found else None

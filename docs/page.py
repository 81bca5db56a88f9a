# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables that commands write into a page, between the lines <!-- NAME: made by … --> and <!-- end -->."""
import pathlib
import re
import sys


def put(lines, name, page):
    """Prints a table, or puts it into its place on a page."""
    text = "\n".join(lines) + "\n"
    if page is None:
        print(text, end="")
        return
    file = pathlib.Path(page)
    before = file.read_text(encoding="utf-8")
    place = re.compile(rf"(<!-- {re.escape(name)}: [^>]*-->\n).*?(<!-- end -->)", re.DOTALL)
    after, count = place.subn(lambda found: found[1] + text + found[2], before)
    if count != 1:
        sys.exit(f"{page} has {count} places for the table {name}")
    file.write_text(after, encoding="utf-8")

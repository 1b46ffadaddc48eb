# SPDX-License-Identifier: LGPL-2.1-or-later
"""What a measurement hands over to be shown."""
import dataclasses


@dataclasses.dataclass
class Text:
    words: str


@dataclasses.dataclass
class Table:
    header: list
    rows: list
    caption: str = ''


@dataclasses.dataclass
class Picture:
    """A file beside the report."""
    name: str
    caption: str


@dataclasses.dataclass
class Section:
    """One item: what was found, in a line, and how."""
    finding: str = ''
    blocks: list = dataclasses.field(default_factory=list)
    missing: list = dataclasses.field(default_factory=list)  # Sequences that are not there.

    def text(self, words):
        self.blocks.append(Text(words))

    def table(self, header, rows, caption=''):
        self.blocks.append(Table(header, rows, caption))

    def picture(self, name, caption):
        self.blocks.append(Picture(name, caption))

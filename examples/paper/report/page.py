# SPDX-License-Identifier: LGPL-2.1-or-later
"""The report as one HTML page, its pictures beside it."""
import html

from . import section

STYLE = '''
body { font: 15px/1.5 sans-serif; max-width: 62em; margin: 2em auto; padding: 0 1em;
color: #1c2226; }
h1 { font-size: 1.6em; }
h2 { font-size: 1.2em; margin-top: 2.2em; border-top: 1px solid #ccd2d6; padding-top: .8em; }
.id { color: #8a9299; font-weight: normal; font-size: .8em; }
table { border-collapse: collapse; margin: 1em 0; font-size: .9em; }
th, td { padding: .2em .7em; border-bottom: 1px solid #dfe3e6; text-align: right; }
th { border-bottom: 2px solid #8a9299; }
td:first-child, th:first-child, .words { text-align: left; }
caption, figcaption { text-align: left; color: #59626a; font-size: .9em; }
figure { margin: 1em 0; } img { max-width: 100%; }
.finding { font-weight: bold; } .missing { background: #fff3cd; padding: .4em .8em; }
.failed { background: #f8d7da; padding: .4em .8em; white-space: pre-wrap; }
'''


WORDS = 20  # What is longer is no number.


def escape(value):
    return html.escape(str(value))


def row(cells, tag, kinds):
    return '<tr>' + ''.join(f'<{tag}{kind}>{escape(cell)}</{tag}>'
                            for cell, kind in zip(cells, kinds)) + '</tr>'


def table_html(header, rows, caption):
    """Columns of words stand at the left, those of numbers at the right."""
    kinds = [' class="words"' if max(len(str(cell)) for cell in column) > WORDS else ''
             for column in zip(*rows)]
    lines = [row(cells, 'td', kinds) for cells in rows]
    if header:
        lines.insert(0, row(header, 'th', kinds))
    if caption:
        lines.insert(0, f'<caption>{escape(caption)}</caption>')
    return '<table>' + '\n'.join(lines) + '</table>'


def block_html(block):
    if isinstance(block, section.Text):
        return f'<p>{escape(block.words)}</p>'
    if isinstance(block, section.Picture):
        return (f'<figure><img src="{escape(block.name)}" alt="{escape(block.caption)}">'
                f'<figcaption>{escape(block.caption)}</figcaption></figure>')
    return table_html(block.header, block.rows, block.caption)


def section_html(item, made):
    """`made`: a Section, or the text of the error that it ended with."""
    parts = [f'<section id="{item.id}">', f'<h2>{escape(item.title)} '
             f'<span class="id">#{item.id}</span></h2>']
    if isinstance(made, str):
        parts.append(f'<p class="failed">This item is missing: {escape(made)}</p>')
    else:
        if made.finding:
            parts.append(f'<p class="finding">{escape(made.finding)}</p>')
        if made.missing:
            parts.append('<p class="missing">Not in the data: '
                         f'{escape(", ".join(made.missing))}</p>')
        parts += [block_html(block) for block in made.blocks]
    return '\n'.join([*parts, '</section>'])


def write(path, machine, notes, sections):
    """sections: [(item, Section or error)]."""
    contents = ' · '.join(f'<a href="#{item.id}">{item.id}</a>' for item, _ in sections)
    body = '\n'.join(section_html(item, made) for item, made in sections)
    told = ''.join(f'<p>{escape(note)}</p>' for note in notes)
    path.write_text(f'''<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>The paper's figures, made again</title>
<style>{STYLE}</style></head><body>
<h1>The paper's tables and figures, made again</h1>
{told}
{table_html([], machine, 'Measured on')}
<p>{contents}</p>
{body}
</body></html>
''', encoding='utf-8')

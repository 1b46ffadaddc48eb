# SPDX-License-Identifier: LGPL-2.1-or-later
"""The paper's tables and figures, made again on this machine: what ../reproduce.sh runs.

registry   what has to be in the report, and which function makes it
workshop   the programs and folders that all of them use
streams    frames through the elements
scenes     made-up frames with known truth
sequences  those of --data, and how masks are scored
published  figures of the paper and of others
section    what a function hands over: paragraphs, tables, plots
plots      all drawing
page       the HTML
areas, trajectories, masks, tracking, phases, windows, claims     measurements, one function an item
"""

#!/bin/sh
# SPDX-License-Identifier: LGPL-2.1-or-later
# Runs a compiler and keeps what it says, for its error stream goes nowhere else under ninja.
#
# usage: nvcc.sh FILE COMMAND...
log=$1
shift
"$@" 2>"$log" || { cat "$log" >&2; exit 1; }

#!/usr/bin/env python3
"""A parameter study: how the sticking part of the foot of the block, and the
force that friction bears, grow with the coefficient of friction.

    python3 tools/python/example.py [study.csv [study.png]]

Writes a table, and draws it with gnuplot if a picture is named."""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import protis  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
DECK = next((d for d in (ROOT / "input/greco/greco.inp",
                         ROOT / "examples/greco/greco.inp") if d.is_file()),
            "greco.inp")  # of the sources, installed, protis --example greco
DRAW = """set terminal pngcairo size 800,480 font 'sans,11'
set output '{picture}'
set datafile separator ','
set xlabel 'coefficient of friction, -'
set ylabel 'friction force, N'
set y2label 'sticking nodes, -'
set y2tics
set ytics nomirror
set key bottom right
set xrange [0:1.1]
set yrange [0:*]
set y2range [0:*]
plot '{table}' using 'mu':'friction' with linespoints pt 7 title 'force', \\
     '' using 'mu':'stick' axes x1y2 with linespoints pt 5 title 'stick'
"""


def main(table="study.csv", picture=None):
    lines = ["mu,friction,stick,largest_pressure"]
    for mu in (0.2, 0.4, 0.6, 0.8, 1.0):
        job = protis.run(DECK, N=16, MU=mu)
        totals = job.table("TOTALS", last=True)
        contact = job.table("CONTACT", last=True)
        stick = (contact["status"] == "STICK").sum()
        lines.append(f"{mu},{-totals['tangential'][0]:.6g},{stick},"
                     f"{contact['pressure'].max():.6g}")
    pathlib.Path(table).write_text("\n".join(lines) + "\n", encoding="utf-8")
    if picture:
        subprocess.run(["gnuplot"], text=True, check=True,
                       input=DRAW.format(picture=picture, table=table))


if __name__ == "__main__":
    main(*sys.argv[1:])

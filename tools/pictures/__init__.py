"""Pictures of Protis' results: what tools/plot, tools/report and the gallery
share. Needs numpy, h5py and matplotlib."""
import pathlib
import warnings

from matplotlib import colors, figure as figures, rcParams

BLUE, RED, GREEN, GREY = "#1b4f9c", "#b5432a", "#2d7a3a", "#666666"
OPEN, SLIP, STICK = "#ffffff", "#f2a100", "#b0124e"

warnings.filterwarnings("ignore", "Glyph .* missing")
rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 10, "axes.titlesize": 10.5,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "grid.color": "#dddddd", "grid.linewidth": 0.6, "axes.axisbelow": True,
    "legend.frameon": False, "legend.fontsize": 9.5, "lines.linewidth": 1.5,
    "lines.markersize": 3.5, "savefig.dpi": 150, "svg.fonttype": "none",
    "svg.hashsalt": "protis", "axes.formatter.useoffset": False})


def plain(text):
    """Text of a user for a picture: no formula."""
    return str(text).replace("$", r"\$")


def empty(width, height):
    """A figure in inches; without pyplot, which takes long to load."""
    return figures.Figure(figsize=(width, height), layout="constrained")


def new(width=9.0, height=4.2, columns=1, ratios=None):
    """A figure in inches and its row of axes."""
    figure = empty(width, height)
    axes = figure.subplots(1, columns, squeeze=False, width_ratios=ratios)
    figure.get_layout_engine().set(w_pad=0.08, wspace=0.04)
    return figure, axes


def legend_below(axes, columns=3, handles=None):
    """The legend under an axes, off its curves and labels."""
    if handles is None:
        handles = axes.get_legend_handles_labels()[0]
    if handles:
        axes.legend(handles=handles, loc="upper center", ncol=columns,
                    bbox_to_anchor=(0.5, 0), columnspacing=1.2,
                    borderaxespad=3.9, handlelength=1.6)


def palette_of(image):
    """256 colours: those of the picture, and the marks', which are rare."""
    from PIL import Image
    used = image.quantize(239, method=Image.Quantize.MEDIANCUT).getpalette()
    for i in range(0, 717, 3):  # paper is white
        if min(used[i:i + 3]) > 245:
            used[i:i + 3] = [255] * 3
    marks = [colors.to_rgb(c) for c in (BLUE, RED, GREEN, GREY, OPEN, SLIP,
                                        STICK, "black")]
    own = [round(255 * (m + share * (1 - m))) for c in marks
           for share in (0, 0.5) for m in c]
    whole = Image.new("P", (1, 1))
    whole.putpalette((used[:717] + own + [255] * 3 + 768 * [0])[:768])
    return whole


def save(figure, path):
    """PNG of 256 colours, or SVG: the same bytes for the same figure."""
    path = pathlib.Path(path)
    if path.suffix == ".svg":
        figure.savefig(path, metadata={"Date": None, "Creator": "Protis"})
    else:
        from PIL import Image
        figure.savefig(path, metadata={"Software": None})
        with Image.open(path) as image:
            whole = image.convert("RGB")
        whole.quantize(palette=palette_of(whole), dither=0).save(path,
                                                                 optimize=True)

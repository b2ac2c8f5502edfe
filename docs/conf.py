"""Sphinx configuration; pages are MyST Markdown, docstrings are in numpy style."""

import logging
import sys
from pathlib import Path

import optlaws

sys.path[:0] = [str(Path(__file__).parent / "_ext"), str(Path(__file__).parents[1])]

project = "optlaws"
author = copyright = "the optlaws developers"
version = release = optlaws.__version__

extensions = [
    "code_lines",
    "docs._ext.made_parts",
    "docstrings",
    "mathml",
    "myst_parser",
    "public_names",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx_gallery.gen_gallery",
    "stacked_tables",
    "stub_names",
]
exclude_patterns = ["_build", "examples", "gallery/*.ipynb", "gallery/*.py", "sg_execution_times.rst"]

# The examples are run whenever the pages are made anew; one that fails ends the build.
sphinx_gallery_conf = {
    "examples_dirs": "examples",
    "gallery_dirs": "gallery",
    "filename_pattern": r"\.py$",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "write_computation_times": False,
    "show_signature": False,
    "capture_repr": (),
    "reset_modules": ("matplotlib", "gallery_style.use"),
    "within_subsection_order": "FileNameSortKey",
}

# A section of the contents may wait for its first page. (suppress_warnings does not reach this warning:
# Sphinx gives it a subtype but no type.)
logging.getLogger("sphinx.sphinx.directives.other").addFilter(
    lambda record: "toctree glob pattern" not in str(record.msg)
)

myst_enable_extensions = ["amsmath", "attrs_inline", "colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 4

autodoc_member_order = "bysource"
toc_object_entries_show_parents = "hide"
autodoc_typehints = "signature"
autodoc_type_aliases = {"Array": "Array"}
python_use_unqualified_type_names = True
add_module_names = False  # docs/_ext/docstrings.py says where a name is imported from
python_maximum_signature_line_length = 100
napoleon_google_docstring = False
napoleon_use_rtype = False
# a property may be listed among the attributes as well: that is no second object
napoleon_use_ivar = True

nitpicky = True
# The documentation is built without a network, hence without other projects' inventories:
# only references to optlaws itself can be resolved, and those must be.
nitpick_ignore_regex = [("py:.*", r"(?!optlaws\.).*"), ("py:.*", r"optlaws\.(.*\.)?_.*")]
# rooms whose inner classes stand in signatures: what of them is public is documented by name
nitpick_ignore_regex.append(("py:class", r"optlaws\.(cams|cycles|entries|exports|shown)\..*"))
# what a solution keeps for its neighbours, and the engine that constants are written over; not public
nitpick_ignore = [
    ("py:class", "optlaws.formulas.tree.Formula"),
    ("py:class", "optlaws.formulas.arithmetic.Arithmetic"),
    ("py:class", "optlaws.results.Struct"),
    ("py:class", "optlaws.results.Spec"),
    ("py:class", "optlaws.numerics.interval.Interval"),
    ("py:class", "optlaws.numerics.taylor.Jet"),
    ("py:class", "optlaws.cams.followers.contact.FollowerContact"),
    ("py:class", "optlaws.cams.followers.faces.FaceContact"),
    ("py:class", "optlaws.cams.followers.rollers.RollerContact"),
    ("py:class", "optlaws.cams.followers.follower.Place"),
    ("py:class", "optlaws.mechanisms.machine.spectrum.WeightPart"),
    ("py:class", "optlaws.mechanisms.machine.residual.BoxEdge"),
    ("py:class", "optlaws.mechanisms.drives.effort.PieceEffort"),
    ("py:class", "optlaws.synthesis.least_time.timed_move.Timed"),
    ("py:class", "optlaws.synthesis.least_time.timed_move.TimedMove"),
    ("py:class", "optlaws.synthesis.least_time.timed_move.TimedT"),
    ("py:class", "optlaws.synthesis.least_time.move_limits.LimitSegments"),
    ("py:class", "optlaws.laws.segments.fractional.PowerSum"),
    ("py:class", "optlaws.motion.quantities.Kind"),
    ("py:class", "optlaws.synthesis.least_time.motor_torque.LossyGear"),
    ("py:class", "optlaws.motion.piece.Piece"),
    ("py:class", "optlaws.formulas.of_motion.MotionFormula"),
    ("py:class", "optlaws.mechanisms.machine.state_space.DriveStretch"),
    ("py:class", "optlaws.mechanisms.machine.state_space.Dynamics"),
    ("py:class", "optlaws.mechanisms.machine.state_space.Panel"),
    ("py:class", "optlaws.mechanisms.machine.models.Mode"),
    ("py:class", "optlaws.mechanisms.machine.state_space.StateSpace"),
    ("py:class", "optlaws.mechanisms.machine.over_time.RiseReturnCycle"),
    ("py:class", "optlaws.synthesis.families.active_set.ActiveSet"),
    ("py:class", "optlaws.synthesis.families.cone.ConeFamily"),
    ("py:class", "optlaws.synthesis.arrays.programs.SolvedBatch"),
    ("py:class", "optlaws.synthesis.program.writer.Model"),
    ("py:class", "optlaws.synthesis.proven.front.T"),
    ("py:class", "optlaws.synthesis.proven.swept_parameter.SweptParameter"),
    ("py:class", "optlaws.synthesis.spaces.space.LawSpace"),
]
# B, C and D are attributes of several classes: which one a text means is said beside it
suppress_warnings = ["ref.python"]

html_theme = "furo"
html_title = f"optlaws {version}"
html_math_renderer = "mathml"
html_static_path = ["_static"]
html_css_files = ["pages.css"]

"""
From the drawing to the loss: an e-axle stage
=============================================

You have the drawing of a planetary stage for an electric axle and want to know how much power
it loses at 15,000 rpm. The drawing gives the sun by its span measurement with allowances,
roughness as *Rz*, and the ring with a negative number of teeth. It says nothing about the
profile shifts of planet and ring.
"""

import tempfile
from pathlib import Path

import epicyclic as ep

drawing = {
    "kind": "planetary",
    "title": "E-axle, stage 1",
    "operation": {
        "input": "sun",
        "fixed": "ring",
        "torque": "150 N*m",
        "speed": "15000 rpm",
        "oil_inlet_temperature": "80 degC",
    },
    "gears": {
        "normal_module": "1.25 mm",
        "normal_pressure_angle": "20 deg",
        "helix_angle": "20 deg",
        "center_distance": "39 mm",
        "basic_rack": "iso-53-c",
    },
    "sun": {
        "teeth": 31,
        "face_width": "26 mm",
        "span_measurement": "17.50 mm",
        "tooth_thickness_allowance": ["-30 um", "-50 um"],
        "roughness": "Rz 2.5 um",
    },
    "planet": {"teeth": 27, "count": 4, "face_width": "25", "roughness": "Rz 2.5 um"},
    "ring": {"teeth": -85, "face_width": "24 mm", "roughnes": "Ra 0.5 um"},
    "sun_mesh": {"normal_backlash": "60 um"},
    "ring_mesh": {"normal_backlash": "80 um"},
    "planet_bearing": {
        "rows": 1,
        "rollers_per_row": 15,
        "roller_diameter": "3 mm",
        "roller_length": "19 mm",
        "pin_diameter": "16 mm",
        "diametral_clearance": "20 um",
        "roller_roughness": "0.1 um",
        "race_roughness": "0.2 um",
    },
    "carrier": {"outer_diameter": "105 mm", "width": "45 mm"},
    "lubricant": {"oil": "atf-dexron-vi"},
}

# %%
# Typing errors are found all at once
# -----------------------------------
# Three slips are left in the tables above. Every one of them comes back with its key, what is
# allowed, and what to do.

try:
    ep.load_case(drawing)
except ep.InputError as error:
    for problem in error.problems:
        print("-", problem)

# %%
# With the slips mended, the case is accepted.

drawing["sun"]["teeth_in_span"] = 5
drawing["planet"]["face_width"] = "25 mm"
drawing["ring"]["roughness"] = drawing["ring"].pop("roughnes")
case = ep.load_case(drawing)

# %%
# What the drawing leaves out
# ---------------------------
# Centre distance, profile shifts and backlash depend on one another. The shifts of planet and
# ring follow here from the stated backlash; every derived value is listed with the reason.

for found in case.found:
    print(found)

# %%
# The gears, to scale:

result = ep.solve(case)
picture = result.plot("gear-set")

# %%
# Where the watts go
# ------------------
# One call gives every loss with the model that computed it.

print(result)
result.table()[["loss [W]", "share of the total"]].round(3)

# %%
picture = result.plot("losses")

# %%
# Read the warnings before you quote the number. Where a model is used beyond the range that it was
# made in, the warning says how many watts that concerns; the largest come first.

for warning in [text for text in result.warnings if text.startswith("Out of range")][:3]:
    print("-", warning)

# %%
# Keep the result, and show it to others
# --------------------------------------
# ``record`` adds what reports and pictures show, ``save_result`` keeps it in a NetCDF file, and
# ``report_html`` turns it into one page without links to the outside. The JSON Schema lets an
# editor complete the keys of a case file.

folder = Path(tempfile.mkdtemp())
ep.save_result(ep.record(case, result=result), folder / "stage-1.nc")
stored = ep.open_result(folder / "stage-1.nc")
(folder / "stage-1.html").write_text(ep.report_html(stored), encoding="utf-8")
print(sorted(path.name for path in folder.iterdir()))
print("tables that a planetary case may have:", len(ep.case_schema()["$defs"]))

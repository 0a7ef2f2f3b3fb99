"""Loss maps for simulators: FMU, VECTO, Modelica, Simscape, Excel."""

from epicyclic.registry import PlugIn

PLUG_IN: PlugIn = {
    "map_formats": {
        "excel": "workbook:EXCEL",
        "matlab": "workbook:MATLAB",
        "vecto": "tables:VECTO",
        "modelica": "tables:MODELICA",
        "simscape": "tables:SIMSCAPE",
        "fmu": "fmu:FMU",
        "gem": "tables:GEM",
    }
}

"""Loss maps for simulators: FMU, VECTO, Modelica, Simscape, Excel."""

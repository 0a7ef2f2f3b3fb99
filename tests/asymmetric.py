"""Cases in which no two numbers are equal, so that a value in the wrong place changes the result.

Every gear has its own width, roughness, material, chamfer, tool and micro-geometry, every mesh its
own misalignment, and all shafts turn, at different speeds.
"""

from __future__ import annotations

from typing import Any

__all__ = ["gear_pair", "planetary"]

Tables = dict[str, Any]


def oil_table(name, kind, viscosities, density, gold):
    """An oil with two measured viscosities by degC, a density, and the law of Gold."""
    temperature, value = density
    return {
        "name": name,
        "kind": kind,
        "kinematic_viscosity": [
            {"temperature": f"{celsius} degC", "value": f"{number} mm^2/s"}
            for celsius, number in viscosities.items()
        ],
        "density": [{"temperature": f"{temperature} degC", "value": f"{value} kg/m^3"}],
        "pressure_viscosity": {"law": "gold", "s": gold[0], "t": gold[1]},
    }


def planetary(between: str = "carrier-housing") -> Tables:
    """The tables of a planetary set of two driven members, its thrust bearing `between` two."""
    return {
        "kind": "planetary",
        "title": "asymmetric planetary set",
        "operation": {
            "input": "sun",
            "second_input": "ring",
            "second_speed": "-410 rpm",
            "torque": "318 N*m",
            "speed": "2900 rpm",
            "oil_inlet_temperature": "67.5 degC",
        },
        "gears": {
            "normal_module": "2.1 mm",
            "normal_pressure_angle": "20.5 deg",
            "helix_angle": "14.3 deg",
            "center_distance": "59.05 mm",
            "addendum_coefficient": 0.93,
            "dedendum_coefficient": 1.27,
        },
        "sun": {
            "teeth": 31,
            "face_width": "27.2 mm",
            "profile_shift_coefficient": 0.057,
            "tip_chamfer": "0.081 mm",
            "roughness": "0.52 um",
            "material": {
                "elastic_modulus": "209 GPa",
                "poisson_ratio": 0.291,
                "density": "7870 kg/m^3",
            },
            "tool_tip_radius": "0.41 mm",
            "micro_geometry": {
                "tip_relief": "4.4 um",
                "tip_relief_roll_length": "1.45 mm",
                "lead_crown": "1.9 um",
                "lead_slope": "1.15 um",
            },
        },
        "planet": {
            "count": 4,
            "teeth": 23,
            "face_width": "25.6 mm",
            "profile_shift_coefficient": 0.171,
            "tip_chamfer": "0.066 mm",
            "roughness": "0.37 um",
            "material": {
                "elastic_modulus": "203 GPa",
                "poisson_ratio": 0.283,
                "density": "7710 kg/m^3",
            },
            "tool_tip_radius": "0.36 mm",
            "mass": "0.345 kg",
            "micro_geometry": {
                "tip_relief": "5.3 um",
                "tip_relief_roll_length": "1.65 mm",
                "profile_slope": "-1.3 um",
            },
            "micro_geometry_ring_side": {
                "root_relief": "3.6 um",
                "root_relief_roll_length": "1.25 mm",
                "profile_crown": "2.2 um",
            },
        },
        "ring": {
            "teeth": 78,
            "face_width": "29.7 mm",
            "profile_shift_coefficient": 0.04,
            "tip_chamfer": "0.054 mm",
            "roughness": "0.85 um",
            "material": {
                "elastic_modulus": "171 GPa",
                "poisson_ratio": 0.275,
                "density": "7150 kg/m^3",
            },
            "tool_tip_radius": "0.22 mm",
            "rim_thickness": "8.3 mm",
            "micro_geometry": {"end_relief": "2.7 um", "end_relief_length": "3.4 mm"},
        },
        "sun_mesh": {"misalignment": "1.8 um"},
        "ring_mesh": {"misalignment": "-2.4 um"},
        "planet_bearing": {
            "rows": 2,
            "rollers_per_row": 13,
            "roller_diameter": "4.7 mm",
            "roller_length": "10.8 mm",
            "pin_diameter": "23.3 mm",
            "diametral_clearance": "14.5 um",
            "roller_roughness": "0.125 um",
            "race_roughness": "0.19 um",
            "viscous_factor": 5.1,
            "cage": "caged",
            "palmgren_coefficient": 0.00037,
            "crown_drop": "2.6 um",
            "crown_length_fraction": 0.18,
            "row_gap": "0.65 mm",
            "material": {
                "elastic_modulus": "207 GPa",
                "poisson_ratio": 0.298,
                "density": "7810 kg/m^3",
            },
        },
        "load_sharing": {"method": "mesh-load-factor", "mesh_load_factor": 1.16},
        "carrier": {"outer_diameter": "148 mm", "width": "44 mm"},
        "thrust_bearing": {
            "mean_diameter": "71 mm",
            "between": between,
            "viscous_factor": 3.8,
            "count": 3,
        },
        "lubricant": {
            "oil": oil_table(
                "asymmetric oil", "ester", {38: 61.3, 99: 9.7}, (15, 905), (6.605, 0.136)
            )
            | {
                "density_slope": {"value": -0.71},
                "lubricant_factor": {"value": 0.78},
                "thermal_conductivity": {"value": "0.144 W/(m*K)"},
            },
            "pressure_viscosity_factor": 1.07,
        },
        "surroundings": {"oil_air_ratio": 0.085, "pressure": "1.22 bar"},
        "models": {
            "friction": "doleschel",
            "boundary_friction": 0.112,
            "fluid_friction": 0.023,
            "pocketing": "isentropic",
            "pocket_end_length": 0.88,
            "planet_tilt": "coupled",
        },
        "numerics": {
            "mesh_positions": 7,
            "contact_segments": 8,
            "bearing_slices": 11,
            "pocket_slices": 6,
            "pocket_steps": 10,
        },
        "losses": {"ring_mesh_rolling": {"factor": 1.35}, "sun_drag": {"factor": 0.92}},
    }


def gear_pair() -> Tables:
    """The tables of a gear pair."""
    return {
        "kind": "gear_pair",
        "title": "asymmetric gear pair",
        "operation": {
            "torque": "187 N*m",
            "speed": "3350 rpm",
            "oil_inlet_temperature": "72.5 degC",
        },
        "gears": {
            "normal_module": "3.3 mm",
            "normal_pressure_angle": "21.4 deg",
            "helix_angle": "17.6 deg",
            "center_distance": "108 mm",
            "addendum_coefficient": 0.96,
            "dedendum_coefficient": 1.29,
        },
        "pinion": {
            "teeth": 19,
            "face_width": "33.7 mm",
            "profile_shift_coefficient": 0.241,
            "tip_chamfer": "0.093 mm",
            "roughness": "0.29 um",
            "material": {
                "elastic_modulus": "208 GPa",
                "poisson_ratio": 0.295,
                "density": "7840 kg/m^3",
            },
            "tool_tip_radius": "0.61 mm",
            "micro_geometry": {
                "tip_relief": "6.2 um",
                "tip_relief_roll_length": "2.35 mm",
                "lead_crown": "2.8 um",
                "profile_slope": "1.7 um",
            },
        },
        "gear": {
            "teeth": 43,
            "face_width": "30.9 mm",
            "profile_shift_coefficient": -0.068,
            "tip_chamfer": "0.117 mm",
            "roughness": "0.74 um",
            "material": {
                "elastic_modulus": "169 GPa",
                "poisson_ratio": 0.277,
                "density": "7120 kg/m^3",
            },
            "tool_tip_radius": "0.53 mm",
            "micro_geometry": {
                "root_relief": "4.1 um",
                "root_relief_roll_length": "1.95 mm",
                "profile_crown": "1.45 um",
                "lead_slope": "-2.15 um",
                "end_relief": "3.8 um",
                "end_relief_length": "2.6 mm",
            },
        },
        "mesh": {"misalignment": "5.7 um"},
        "lubricant": {
            "oil": oil_table(
                "another asymmetric oil", "pao", {41: 96.4, 97: 15.6}, (16, 858), (7.382, 0.134)
            )
            | {
                "density_slope": {"value": -0.64},
                "lubricant_factor": {"value": 0.83},
                "thermal_conductivity": {"value": "0.152 W/(m*K)"},
            },
            "pressure_viscosity_factor": 0.94,
        },
        "surroundings": {"oil_air_ratio": 0.065, "pressure": "1.18 bar"},
        "models": {
            "friction": "doleschel",
            "boundary_friction": 0.104,
            "fluid_friction": 0.027,
            "pocketing": "isentropic",
            "pocket_end_length": 0.87,
        },
        "numerics": {
            "mesh_positions": 9,
            "contact_segments": 7,
            "pocket_slices": 6,
            "pocket_steps": 10,
        },
        "losses": {"mesh_rolling": {"factor": 1.55}, "drag": {"factor": 0.91}},
    }

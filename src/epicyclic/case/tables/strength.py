"""Table of a case on the strength of its gears and the life of its bearings."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from epicyclic.case.tables.base import Stress
from epicyclic.schema.fields import Table, option
from epicyclic.units import Number, Quantity, SmallLength

Life = Annotated[float, Quantity("a time", "s", "h", low=0.0, high=1e7, open_low=True)]
Factor = Annotated[Number, Field(ge=1, le=10)]
MaterialClass = Literal[
    "case-hardened-ml",
    "case-hardened-mq",
    "case-hardened-me",
    "through-hardened-ml",
    "through-hardened-mq",
    "through-hardened-me",
    "nitrided-mq",
    "nitrided-through-hardening-mq",
    "flame-hardened-mq",
]


class GearStrength(Table):
    """What one gear bears."""

    material: MaterialClass = option("Class of ISO 6336-5.", "case-hardened-mq")
    hardness: Number | None = option(
        "Vickers, of the flanks. Default: of the class.", gt=0, le=1200
    )
    contact_strength: Stress | None = option("sigma_Hlim. Default: of the class.")
    bending_strength: Stress | None = option("sigma_Flim. Default: of the class.")
    flank_height: SmallLength | None = option("Rz of the flanks. Default: 6 Ra.")
    root_height: SmallLength = option("Rz of the roots (estimate).", "20 um")
    mean_stress_factor: Number | None = option(
        "Y_M. Default: 0.7 if both flanks carry, as on planets, else 1.", gt=0, le=1
    )


class MeshStrength(Table):
    """Factors on the load of one mesh."""

    mesh_load_factor: Factor | None = option(
        "K_gamma. Default: the share of the planet that carries most, as computed."
    )
    dynamic_factor: Factor | None = option("K_v. Default: after ISO 6336-1, method B.")
    face_load_factor: Factor | None = option(
        "K_Hbeta. Default: from the computed load along the contact lines."
    )
    transverse_load_factor: Factor | None = option(
        "K_Halpha and K_Falpha. Default: after ISO 6336-1."
    )


class StrengthTable(MeshStrength):
    """Loads, lives and strengths, for safety factors after ISO 6336 and ISO 281."""

    STAND_INS: ClassVar[dict[str, object]] = {"gears": {}, "meshes": {}}

    life: Life = option("At the operating point.", "20000 h")
    application_factor: Factor = option("K_A.", 1.0)
    accuracy_class: int = option(
        "Of ISO 1328-1, for K_v and K_Halpha of gears without one (estimate).", 6, ge=1, le=11
    )
    scuffing_stage: int | None = option(
        "Failure load stage of the oil, FZG A/8.3/90. Default: by the kind of oil.", ge=1, le=14
    )
    micropitting_stage: int | None = option(
        "Failure load stage of the oil, FVA 54/7. Default: by the kind of oil.", ge=5, le=10
    )
    contamination_factor: Number = option("e_C of ISO 281 (estimate).", 0.5, gt=0, le=1)
    gears: dict[str, GearStrength] = option(
        'By the name of a gear, "sun", of a train "P1.sun"; those left out have the defaults.', {}
    )
    meshes: dict[str, MeshStrength] = option(
        'Load factors of one mesh, by its name, "sun_mesh", of a train "P1.sun_mesh".', {}
    )

    def __hash__(self) -> int:  # a table of names cannot be hashed
        return hash((self.life, self.application_factor, self.face_load_factor))


STRENGTH: Any = option("For safety factors against damage, shown beside the losses.")

"""The published regressions for flanks of unequal roughness.

They know the composite roughness only, which hardly falls when one of two rough flanks is polished;
but a polished flank keeps the ridges of the other from meeting any. The regression is therefore
taken where both flanks are as rough as the rougher one, and from there the solver of this package
tells what the smoother flank changes, by its fit to contacts of the same oil.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from epicyclic import library
from epicyclic.contact import LineContacts
from epicyclic.oilmodel.model import OilModel, read_oil_model

FloatArray = NDArray[np.float64]

SIMULATED = "atf-talbot-2012"
"""The oil of the regressions, whose contacts were simulated."""


def equally_rough(contact: LineContacts) -> LineContacts:
    """The contacts with both surfaces as rough as the rougher one."""
    rougher = np.maximum(*contact.roughness) + np.zeros(contact.radius.shape)
    return contact.changed(roughness1=rougher, roughness2=rougher)


def pairing_ratio(
    quantity: str,  # ``"friction"`` or ``"rolling_loss"``.
    contact: LineContacts,  # n of them.
) -> FloatArray:
    """A quantity over what it is with both surfaces as rough as the rougher one. Theory (O13). [1]

    Returns
    -------
    ndarray, shape (n,)

    Examples
    --------
    >>> import numpy as np
    >>> from epicyclic.contact import contacts_at
    >>> given = dict(
    ...     slide_to_roll_ratio=0.3, rolling_speed=10.0, radius=0.01, hertz_pressure=1e9,
    ...     roughness1=0.4e-6, roughness2=0.4e-6, dynamic_viscosity=6e-3, pressure_viscosity=11e-9,
    ... )
    >>> arrays = {name: np.array([value]) for name, value in given.items()}
    >>> pairing_ratio("friction", contacts_at(**arrays, equivalent_modulus=2.3e11))
    array([1.])
    """
    model = _simulated()
    ratio: FloatArray = model.value(quantity, contact) / model.value(
        quantity, equally_rough(contact)
    )
    return ratio


@lru_cache(maxsize=1)
def _simulated() -> OilModel:
    file = library.oil_model_file(SIMULATED)
    assert file is not None
    return read_oil_model(file)

"""Power to turn a free disc or cylinder in a large body of fluid at rest."""

from __future__ import annotations

import math


def laminar_disc_power(
    radius: float,  # [m]
    speed: float,  # omega. [rad/s]
    density: float,  # [kg/m^3]
    kinematic_viscosity: float,  # nu, with Re = omega r^2/nu up to about 3e5. [m^2/s]
) -> float:
    """Both faces of a disc in laminar flow: C_M = 3.87 Re^-1/2, P = C_M rho omega^3 r^5/2.

    Returns
    -------
    float
        [W]

    References
    ----------
    T. von Karman, ZAMM 1 (1921) 233, constant of W. G. Cochran (1934), as quoted in H. Schlichting,
    Boundary-Layer Theory, 7th ed. (1979).
    """
    reynolds = speed * radius**2 / kinematic_viscosity
    return 3.87 / math.sqrt(reynolds) * density * speed**3 * radius**5 / 2


def turbulent_disc_power(
    radius: float,  # As for `laminar_disc_power`, Re above about 3e5.
    speed: float,  # As for `laminar_disc_power`, Re above about 3e5.
    density: float,  # As for `laminar_disc_power`, Re above about 3e5.
    kinematic_viscosity: float,  # As for `laminar_disc_power`, Re above about 3e5.
) -> float:
    """Both faces of a disc in turbulent flow: C_M = 0.146 Re^-1/5, P = C_M rho omega^3 r^5/2.

    Returns
    -------
    float
        [W]

    References
    ----------
    T. von Karman, ZAMM 1 (1921) 233, as quoted in H. Schlichting, Boundary-Layer Theory, 7th ed.
    (1979).
    """
    reynolds = speed * radius**2 / kinematic_viscosity
    return 0.146 * math.pow(reynolds, -0.2) * density * speed**3 * radius**5 / 2


def cylinder_power(
    radius: float,  # [m]
    length: float,  # [m]
    speed: float,  # omega. [rad/s]
    dynamic_viscosity: float,  # mu. [Pa s]
) -> float:
    """A cylinder in an unbounded viscous fluid: shear stress 2 mu omega at its surface.

    Exact solution of the Navier-Stokes equations, v = omega r^2/R.

    Returns
    -------
    float
        P = 4 pi mu l omega^2 r^2. [W]

    References
    ----------
    H. Schlichting, Boundary-Layer Theory, 7th ed. (1979).
    """
    stress = 2 * dynamic_viscosity * speed
    area = 2 * math.pi * radius * length
    return stress * area * radius * speed


def dawson_windage(
    root_diameter: float,  # [m]
    width: float,  # [m]
    module: float,  # [m]
    rpm: float,
) -> float:
    """Windage of a spur gear in the open in air: 1e-20 n^2.9 (0.16 D^3.9 + D^2.9 b^0.75 m^1.15) kW.

    Returns
    -------
    float
        [W]

    References
    ----------
    P. H. Dawson, Proc. IMechE 198A (1984) 51; mm and rpm; second hand.
    """
    d, b, m = 1e3 * root_diameter, 1e3 * width, 1e3 * module
    return 1e3 * 1e-20 * rpm**2.9 * (0.16 * d**3.9 + d**2.9 * b**0.75 * m**1.15)


def dimensional_windage(
    teeth: int,
    pitch_radius: float,  # [m]
    width: float,  # [m]
    speed: float,  # [rad/s]
    density: float,  # [kg/m^3]
    viscosity: float,  # [Pa s]
) -> float:
    """Windage in the open by C = 60 Re^-1/4 (b/R)^0.8 z^-0.4 2 (1/2)^0.56, P = C rho w^3 R^5/2.

    Returns
    -------
    float
        [W]

    References
    ----------
    Y. Diab, F. Ville, P. Velex, C. Changenet, J. Mech. Des. 126 (2004) 903, dimensional analysis;
    second hand.
    """
    reynolds = density * speed * pitch_radius**2 / viscosity
    shape = (width / pitch_radius) ** 0.8 * teeth**-0.4 * 2 * 0.5**0.56
    return 60 * reynolds**-0.25 * shape * density * speed**3 * pitch_radius**5 / 2

#!/usr/bin/env python3
"""Writes the loading curves of a brain specimen to scenes/curves/, or to the folder given: brain_curves.py [FOLDER].

The experimental curves behind the quasi non-linear correction are not public, the law that was fitted to them is:
the hyper-viscoelastic law of Miller and Chinzei (Journal of Biomechanics 30, 1997). Its strain energy is

    W = int_0^t  sum_ij C_ij g(t - tau)  d/dtau [ (J1 - 3)^i (J2 - 3)^j ]  dtau,
    g(t) = 1 - g1 (1 - exp(-t/tau1)) - g2 (1 - exp(-t/tau2)),

with the invariants J1, J2 of the left Cauchy-Green strain, C10 = C01, C20 = C02 and no mixed term.

A cylinder of radius R and height h between plates on which its ends slide freely is pressed by x = v t. The state is
homogeneous; the tissue is incompressible:

    lambda = 1 - x/h  along the axis,  lambda^(-1/2)  across it,
    J1 = lambda^2 + 2/lambda,   J2 = lambda^-2 + 2 lambda.

The nominal axial stress is dW/dlambda. With the elastic part

    T0(lambda) = 2 (lambda - lambda^-2) (C10 + 2 C20 (J1 - 3)) + 2 (1 - lambda^-3) (C01 + 2 C02 (J2 - 3))

it is T(t) = int_0^t g(t - tau) dT0/dtau dtau. The force on the plate is -pi R^2 T and the radius grows by
R (lambda^(-1/2) - 1), whatever the speed.
"""
import pathlib
import sys

import numpy as np

C1, C2 = 263.0, 491.0                      # C10 = C01, C20 = C02 [Pa]
RELAXATION = ((0.450, 0.5), (0.365, 50.0))  # g_k [1], tau_k [s]
RADIUS, HEIGHT = 0.015, 0.013              # [m]
SPEEDS_MM_MIN = (500, 5, 0.005)
STRAIN = 0.30                              # at the end of the loading
POINTS, SUBSTEPS = 40, 500


def elastic_stress(stretch):
    """Nominal stress [Pa] of an instantaneous press."""
    j1 = stretch**2 + 2 / stretch
    j2 = stretch**-2 + 2 * stretch
    return (2 * (stretch - stretch**-2) * (C1 + 2 * C2 * (j1 - 3))
            + 2 * (1 - stretch**-3) * (C1 + 2 * C2 * (j2 - 3)))


def force_curve(speed):
    """Displacements [m] and forces [N] of a press at `speed` [m/s]."""
    x = np.linspace(0, STRAIN * HEIGHT, POINTS * SUBSTEPS + 1)
    dt = x[1] / speed
    increments = np.diff(elastic_stress(1 - x / HEIGHT))
    # T = (1 - g1 - g2) T0 + sum_k g_k H_k, H_k being T0 forgotten at the rate 1/tau_k. Over one step T0 grows at a
    # constant rate, which is integrated exactly.
    stress = (1 - sum(g for g, _ in RELAXATION)) * np.concatenate([[0], np.cumsum(increments)])
    for g, tau in RELAXATION:
        keep, gain = np.exp(-dt / tau), -np.expm1(-dt / tau) * tau / dt
        branch = np.zeros_like(stress)
        for i, increment in enumerate(increments):
            branch[i + 1] = keep * branch[i] + gain * increment
        stress += g * branch
    return x[::SUBSTEPS], 0.0 - np.pi * RADIUS**2 * stress[::SUBSTEPS]


def write(path, column, x, y, remark):
    rows = "".join(f"{a:.9g},{b:.9g}\n" for a, b in zip(x, y))
    path.write_text(f"# {remark}\n# written by scripts/brain_curves.py\ndisplacement_m,{column}\n{rows}")
    print(f"{path}: {column} {y[-1]:.6g} at {x[-1]:.6g} m")


def main():
    scenes = pathlib.Path(__file__).resolve().parent.parent / "scenes"
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else scenes / "curves"
    folder.mkdir(parents=True, exist_ok=True)
    specimen = f"brain specimen, radius {RADIUS} m, height {HEIGHT} m, loading"
    for speed in SPEEDS_MM_MIN:
        x, force = force_curve(speed * 1e-3 / 60)
        write(folder / f"brain_force_{speed}mm_min.csv", "force_N", x, force, f"{specimen} at {speed} mm/min")
    radial = RADIUS * ((1 - x / HEIGHT) ** -0.5 - 1)
    write(folder / "brain_radial.csv", "radial_m", x, radial, f"{specimen} at any speed")


if __name__ == "__main__":
    main()

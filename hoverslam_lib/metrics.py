"""How far is a computed solution from the exact one?

`exact` and `approx` are arrays of the same shape, one entry a sample, in the same unit.
"""

import numpy as np

from hoverslam_lib import _validate


def mape(exact, approx):
    """Mean absolute percentage error, eq. 4.3 of the paper, as a fraction (no factor 100).

    Every sample is divided by its own exact value, so one sample near a zero of the exact solution
    outweighs all others.

    Parameters
    ----------
    exact, approx : array_like, same shape, same unit

    Returns
    -------
    float
        Dimensionless.

    Raises
    ------
    ValueError, TypeError
        If the shapes differ, if they are no numbers, or if an exact value is 0, where eq. 4.3 is undefined.
    """
    exact, approx = samples(exact=exact, approx=approx)
    zeros = np.flatnonzero(exact == 0)
    if zeros.size:
        raise ValueError(
            f"mape is undefined where the exact value is 0 (sample {zeros[0]}): leave such samples out, or use nmae"
        )
    return float(np.mean(np.abs((exact - approx) / exact)))


def nmae(exact, approx):
    """Mean absolute error divided by the amplitude, the largest absolute exact value.

    Parameters
    ----------
    exact, approx : array_like, same shape, same unit

    Returns
    -------
    float
        Dimensionless.

    Raises
    ------
    ValueError, TypeError
        If the shapes differ, if they are no numbers, or if the exact solution is 0 throughout.
    """
    exact, approx = samples(exact=exact, approx=approx)
    amplitude = np.max(np.abs(exact))
    if amplitude == 0:
        raise ValueError("nmae is undefined for an exact solution that is 0 throughout: use max_error")
    return float(np.mean(np.abs(exact - approx)) / amplitude)


def rmse(exact, approx):
    """Root mean square error, in the unit of the samples."""
    exact, approx = samples(exact=exact, approx=approx)
    return float(np.sqrt(np.mean((exact - approx) ** 2)))


def max_error(exact, approx):
    """Largest absolute error over all samples (the max-norm), in the unit of the samples."""
    exact, approx = samples(exact=exact, approx=approx)
    return float(np.max(np.abs(exact - approx)))


def observed_order(dt, error):
    """Order p of a method, measured: the slope of log(error) against log(dt), since error ≈ C·dt**p.

    Parameters
    ----------
    dt : array_like, shape (n,), n ≥ 2
        Step sizes [s], not all the same.
    error : array_like, shape (n,)
        Error at each of them, greater than 0.

    Returns
    -------
    float
        The least-squares slope; with two values, log(e1/e2) / log(dt1/dt2).

    Raises
    ------
    ValueError
        If there are fewer than two values or one is not finite and greater than 0.
    """
    dt, error = samples(dt=dt, error=error)
    if dt.ndim != 1 or dt.size < 2 or np.all(dt == dt[0]):
        raise ValueError("observed_order needs at least two different values of dt")
    if not (np.all((dt > 0) & (dt < np.inf)) and np.all((error > 0) & (error < np.inf))):
        raise ValueError("observed_order needs every dt and every error finite and greater than 0")
    x, y = np.log(dt), np.log(error)
    x = x - x.mean()
    return float(x @ y / (x @ x))


def samples(**pair):
    """Two arrays of samples, given by name, as float arrays of one shape."""
    a, b = (_validate.array(name, value) for name, value in pair.items())
    if a.shape != b.shape:
        raise ValueError(f"{' and '.join(pair)} must have the same shape; got {a.shape} and {b.shape}")
    if a.size == 0:
        raise ValueError(f"there are no samples in {' and '.join(pair)}")
    return a, b

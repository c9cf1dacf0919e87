"""Root of a continuous function in a bracket: of one, and of many at once."""

import math

import numpy as np


def bracketed_root(g, a, b, ga, gb, *, xtol=0.0):
    """Return x in [a, b] with g(x) = 0, given ga = g(a) and gb = g(b) of opposite signs (or one of them 0).

    The root is found to xtol, and to the last two digits if that is smaller.

    T. R. Chandrupatla, Advances in Engineering Software 28 (1997) 145-149: inverse quadratic interpolation where the
    three latest points allow it, else bisection; here the first guess is linear. The root never leaves the bracket,
    which is why the method is used: near a soft landing, plain Newton leaves for another root. Values of g may be
    infinite.

    Raises
    ------
    ValueError
        If ga and gb have the same sign.
    """
    if ga == 0:
        return a
    if gb == 0:
        return b
    if (ga < 0) == (gb < 0):
        raise ValueError(f"g has the same sign at both ends: g({a:g}) = {ga:g}, g({b:g}) = {gb:g}")
    # a is the newest point, b the other end of the bracket, c the point before
    a, b, ga, gb = b, a, gb, ga
    fraction = min(max(ga / (ga - gb), 0.01), 0.99) if math.isfinite(ga - gb) else 0.5
    while True:
        x = a + fraction * (b - a)
        gx = g(x)
        if (gx < 0) == (ga < 0):
            c, gc = a, ga
        else:
            b, c, gb, gc = a, b, ga, gb
        a, ga = x, gx

        best, g_best = (a, ga) if abs(ga) < abs(gb) else (b, gb)
        smallest_fraction = max(xtol, 2 * math.ulp(best)) / abs(b - a) if a != b else 1.0
        if g_best == 0 or smallest_fraction > 0.5:
            return best

        fraction = 0.5
        xi, phi = (a - b) / (c - b), (ga - gb) / (gc - gb)
        if phi**2 < xi and (1 - phi) ** 2 < 1 - xi:
            fraction = ga / (gb - ga) * gc / (gb - gc) + (c - a) / (b - a) * ga / (gc - ga) * gb / (gc - gb)
        fraction = min(max(fraction, smallest_fraction), 1 - smallest_fraction)


def bracketed_roots(g, a, b, ga, gb, *, xtol=0.0):
    """Return for each lane of an array what `bracketed_root` returns, with g a function of an array x.

    Each lane is left alone as soon as its root is found, so that it does not depend on the others.
    """
    a, b, ga, gb, xtol = (np.array(x, dtype=float) for x in np.broadcast_arrays(b, a, gb, ga, xtol))
    x, c, gc, found = a.copy(), a, ga, (ga == 0) | (gb == 0)
    x[gb == 0] = b[gb == 0]
    with np.errstate(all="ignore"):  # of lanes that are found, and of values that are infinite
        fraction = np.clip(np.where(np.isfinite(ga - gb), ga / (ga - gb), 0.5), 0.01, 0.99)
        while not found.all():
            x = np.where(found, x, a + fraction * (b - a))
            gx = g(x)
            same = (gx < 0) == (ga < 0)
            b, c, gb, gc = np.where(same, b, a), np.where(same, a, b), np.where(same, gb, ga), np.where(same, ga, gb)
            a, ga = x, gx

            nearer = abs(ga) < abs(gb)
            best, g_best = np.where(nearer, a, b), np.where(nearer, ga, gb)
            smallest = np.where(a != b, np.maximum(xtol, 2 * np.spacing(abs(best))) / abs(b - a), 1.0)
            ends = ~found & ((g_best == 0) | (smallest > 0.5))
            x, found = np.where(ends, best, x), found | ends

            xi, phi = (a - b) / (c - b), (ga - gb) / (gc - gb)
            fraction = ga / (gb - ga) * gc / (gb - gc) + (c - a) / (b - a) * ga / (gc - ga) * gb / (gc - gb)
            fraction = np.where((phi * phi < xi) & ((1 - phi) * (1 - phi) < 1 - xi), fraction, 0.5)
            fraction = np.minimum(np.maximum(fraction, smallest), 1 - smallest)
    return x

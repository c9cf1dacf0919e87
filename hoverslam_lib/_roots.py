"""Root of a continuous function in a bracket."""

import math


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

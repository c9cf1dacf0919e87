"""Solutions to the exercises of lesson 1."""

# %% 1.1 · two steps by hand
# a = -(6 N/m)/(2 kg) · x = -3 x; each line uses the one before it:
# v = 1 - 0.1 · 3 · 2 = 0.4,         x = 2 + 0.1 · 0.4 = 2.04
# v = 0.4 - 0.1 · 3 · 2.04 = -0.212, x = 2.04 + 0.1 · (-0.212) = 2.0188
my_x = 2.0188
my_v = -0.212


# %% 1.2 · three bugs in one measure
def my_mean_error(exact, computed):
    total = 0.0
    for A, F in zip(exact, computed, strict=True):
        total += abs(A - F)  # after the sum, errors of opposite sign would have cancelled
    amplitude = max(abs(A) for A in exact)  # the largest in size, on whichever side it lies
    return total / len(exact) / amplitude  # a mean over samples, one more than steps


# %% 1.3 · two measures disagree
# P is wrong by p at 3 m only, Q by q at 0.01 m only. By the MAPE, Q is (q/0.01) / (p/3) = 300 q/p times worse,
# by the NMAE P is p/q times worse. Both are at least 10 if q/p lies between 1/30 and 1/10; here it is 1/20.
my_exact = [3.0, 0.01]
my_p = [3.2, 0.01]
my_q = [3.0, 0.02]

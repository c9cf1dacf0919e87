"""Solutions to the exercises of lesson 9."""

# %% 9.1 · how many halvings
# 1 s is 1147 m wide, and n halvings divide by 2^n. 2^20 = 1 048 576 is not yet 1 147 000, and 2^21 is more
my_halvings = 21

# %% 9.2 · forge a landing
# by trial: with 0.016 s and 0.014 s. The last step before mass zero decides, and the step size decides where that is
my_landing_dt = 0.016
my_crash_dt = 0.014


# %% 9.3 · twelve flights, not thirty
def my_search(height, early, late):
    # the secant method: the straight line through the last two tries says where to try next
    h_early, h_late = height(early), height(late)
    for _ in range(10):
        if h_early == h_late:
            break
        early, late = late, late - h_late * (late - early) / (h_late - h_early)
        if abs(late - early) < 1e-10:
            break
        h_early, h_late = h_late, height(late)
    return late

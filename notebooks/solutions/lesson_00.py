"""Solutions to the exercises of lesson 0."""


# %% 0.1 · metres per second
def my_metres_per_second(kilometres_per_hour):
    # 1000 m in a kilometre, 3600 s in an hour
    return kilometres_per_hour * 1000 / 3600

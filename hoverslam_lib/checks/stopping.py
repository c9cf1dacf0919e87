"""Running an answer so that it ends: within a time limit, whatever it catches."""

import _thread
import ctypes
import signal
import sys
import threading

PAUSE = 0.05
"""So often [s] is an answer thrown out again that catches what it is thrown out with."""


_throw = ctypes.PYFUNCTYPE(ctypes.c_int, ctypes.c_ulong, ctypes.c_void_p)(
    ("PyThreadState_SetAsyncExc", ctypes.pythonapi)
)


class TimeIsUp(BaseException):
    """Thrown into an answer that does not end; not an Exception, so that few answers catch it."""


def limited(work, seconds):
    """Call ``work()``, in this thread, and raise `TimeIsUp` if it takes longer.

    It runs in the main thread, as a cell does, so *Interrupt* stops it like any other loop. The alarm is a signal,
    which Python answers between two of its instructions, in arithmetic with huge integers and in ``time.sleep``. It
    cannot stop other code that is written in C while that runs; nor can *Interrupt*. Windows has no timer of signals:
    there a thread has to call for one, and ``9**9**8`` and a sleep are not stopped either. Outside the main thread
    nothing is.
    """
    if threading.current_thread() is not threading.main_thread():
        return work()
    timer = hasattr(signal, "setitimer")
    number = signal.SIGALRM if timer else signal.SIGTERM
    before, tracing, waiting = signal.getsignal(number), sys.gettrace(), threading.Lock()
    armed, followed = [True], []

    def ring(number, frame):
        """Throw the answer out, and from the second time on, because it catches that, follow it line by line."""
        if armed:
            armed.append(True)
            if len(armed) > 2:
                followed.append(True)
                while frame.f_code is not limited.__code__:
                    frame.f_trace = _follow
                    frame = frame.f_back
                sys.settrace(_follow)
            raise TimeIsUp

    waiting.acquire()
    signal.signal(number, ring)
    try:
        try:
            if timer:
                signal.setitimer(signal.ITIMER_REAL, seconds, PAUSE)
            else:
                threading.Thread(target=_call, args=(number, seconds, waiting), daemon=True).start()
            return work()
        finally:
            while True:
                try:  # nothing but C from here on, until nothing is thrown any more
                    armed.clear()  # first: from here on no alarm throws
                    if timer:
                        signal.setitimer(signal.ITIMER_REAL, 0)
                    if waiting.locked():
                        waiting.release()
                    if followed:
                        sys.settrace(tracing)
                        followed.clear()
                        # what may be on its way is replaced and waited for: only its arrival lets Python run as before
                        _throw(threading.get_ident(), id(TimeIsUp))
                        while True:
                            pass
                    break
                except TimeIsUp:
                    continue
    finally:
        signal.signal(number, before)


def _call(number, seconds, waiting):
    while not waiting.acquire(timeout=seconds):
        _thread.interrupt_main(number)
        seconds = PAUSE


def _follow(frame, event, argument):
    if frame.f_code.co_filename == __file__:
        return None
    if event == "line":
        _throw(threading.get_ident(), id(TimeIsUp))  # does not raise here and now, so the tracing goes on
    return _follow

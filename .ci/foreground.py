"""Run a command as the terminal's foreground job, apart from `make`.

At Ctrl-C a terminal signals the whole foreground group, and make, being in it, ends by the signal
whatever its recipe returns. Alone in the foreground, the command ends in its own way and make
passes on its exit code. Without a terminal the command simply takes this process's place.
"""

import os
import signal
import subprocess
import sys

command = sys.argv[1:]
try:
    terminal = os.open('/dev/tty', os.O_RDWR | os.O_CLOEXEC)
    foreground = os.tcgetpgrp(terminal) == os.getpgrp()
except OSError:
    foreground = False
if not foreground:
    os.execvp(command[0], command)


def take_terminal():
    """In the child, before it becomes the command."""
    os.tcsetpgrp(terminal, os.getpid())


# Ctrl-Z would stop the command alone and leave make waiting for it.
signal.signal(signal.SIGTSTP, signal.SIG_IGN)
# Handing the terminal over and taking it back happen in the background: no reason to stop.
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
child = subprocess.Popen(command, process_group=0, preexec_fn=take_terminal)
for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(ending, lambda number, _: child.send_signal(number))
code = child.wait()
os.tcsetpgrp(terminal, os.getpgrp())
sys.exit(code if code >= 0 else 128 - code)

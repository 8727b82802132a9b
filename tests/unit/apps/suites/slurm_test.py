"""`footfall sweep --slurm` on a real Slurm of one node: slurm_test.py BINARY.

Starts munged, slurmctld and slurmd with files, ports and a key of their own, and ends them. Needs root. Exit code 77
where something is missing: skipped.
"""
import contextlib
import ctypes
import os
import shutil
import socket
import sqlite3
import subprocess
import time

from command import BINARY, SOURCE, Case, main

DAEMONS = ("munged", "slurmctld", "slurmd")
PATH = os.environ["PATH"] + ":/usr/sbin:/sbin"


def missing():
    gone = [name for name in (*DAEMONS, "sbatch", "squeue", "scontrol") if not shutil.which(name, path=PATH)]
    if gone:
        return f"{', '.join(gone)} not installed (Debian: munge, slurm-wlm)"
    return "" if os.geteuid() == 0 else "slurmd needs root here"


def free_port():
    with contextlib.closing(socket.socket()) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Slurm:
    """A cluster of this machine, in a folder of its own."""

    def __init__(self, folder):
        self.folder = folder
        self.processes = []
        self.environment = dict(os.environ, PATH=PATH, SLURM_CONF=str(folder / "slurm.conf"))
        for name in ("state", "spool", "log", "munge"):
            (folder / name).mkdir(mode=0o755)
        self.write_configuration()

    def write_configuration(self):
        host = socket.gethostname().split(".")[0]
        cpus = os.cpu_count()
        (self.folder / "slurm.conf").write_text(f"""ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={free_port()}
SlurmdPort={free_port()}
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket={self.folder}/munge/socket
CredType=cred/munge
StateSaveLocation={self.folder}/state
SlurmdSpoolDir={self.folder}/spool
SlurmctldPidFile={self.folder}/slurmctld.pid
SlurmdPidFile={self.folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,bf_interval=1,batch_sched_delay=0
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=all Nodes={host} Default=YES State=UP
""")

    def start(self):
        munge = self.folder / "munge"
        (munge / "key").write_bytes(os.urandom(1024))
        (munge / "key").chmod(0o400)
        self.daemon("munged", "--foreground", "--force", f"--socket={munge}/socket", f"--key-file={munge}/key",
                    f"--pid-file={munge}/pid", f"--log-file={munge}/log", f"--seed-file={munge}/seed")
        wait(lambda: (munge / "socket").exists(), 20)
        self.daemon("slurmctld", "-D")
        self.daemon("slurmd", "-D")
        wait(lambda: "idle" in self.call("sinfo", "-h", "-o", "%t", check=False), 60)

    def daemon(self, *command):
        with open(self.folder / "log" / command[0], "w") as log:
            self.processes.append(subprocess.Popen(command, env=self.environment, stdout=log, stderr=log,
                                                   stdin=subprocess.DEVNULL))

    def call(self, *command, check=True):
        done = subprocess.run(command, env=self.environment, cwd=SOURCE, capture_output=True, text=True, timeout=60,
                              stdin=subprocess.DEVNULL)
        if check and done.returncode:
            raise AssertionError(f"{' '.join(command)}: {done.stdout}{done.stderr}{self.logs()}")
        return done.stdout

    def logs(self):
        return "".join(f"\n--- {p.name}\n{p.read_text()[-1500:]}" for p in (self.folder / "log").iterdir())

    def stop(self):
        for process in reversed(self.processes):
            process.terminate()
        for process in reversed(self.processes):
            try:
                process.wait(20)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        # Job steps have left their daemon and are children of this process now.
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG) != (0, 0):
                pass


def wait(condition, seconds):
    end = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > end:
            raise AssertionError("no answer in time")
        time.sleep(0.2)


class OnSlurm(Case):
    def setUp(self):
        super().setUp()
        self.folder.chmod(0o755)  # munged refuses what others can write
        self.slurm = Slurm(self.folder)
        self.addCleanup(self.slurm.stop)
        self.slurm.start()
        self.out = self.folder / "out"

    def submit(self):
        self.slurm.call("bash", str(self.out / "slurm.sh"))
        wait(lambda: not self.slurm.call("squeue", "-h").strip(), 120)

    def results(self):
        database = sqlite3.connect(self.out / "sweep.sqlite")
        rows = database.execute("SELECT id, status, finished FROM runs ORDER BY id").fetchall()
        database.close()
        return rows

    def test_a_job_array_of_shards_gives_every_run_once_and_again_repeats_none(self):
        self.slurm.call(BINARY, "sweep", "balance_best", "--vary", "lift_time=140ms..150ms:2", "--seeds", "1..4", "--for",
                        "0.5s", "--out", str(self.out), "--slurm", "3", "--jobs", "1")
        self.submit()
        tail = "".join(p.read_text() for p in self.out.glob("slurm-*.log")) + self.slurm.logs()
        self.assertTrue((self.out / "sweep.sqlite").exists(), tail)
        first = self.results()
        self.assertEqual([(i, s) for i, s, _ in first], [(i, "passed") for i in range(8)], tail)
        self.assertEqual(len(list(self.out.glob("shard-*-of-3.sqlite"))), 3)
        self.assertTrue((self.out / "report.html").exists())
        self.submit()
        self.assertEqual(self.results(), first)


if __name__ == "__main__":
    ctypes.CDLL(None).prctl(36, 1)  # PR_SET_CHILD_SUBREAPER: nothing that it starts outlives it unseen
    main(skipped=missing())

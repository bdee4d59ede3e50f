# SPDX-FileCopyrightText: 2026 The doorforge authors
# SPDX-License-Identifier: Apache-2.0
"""Loads exported doors in a physics engine and measures what holds them and what lets them go.

  judge.py CLIENT --probe OUT.json     writes {"version": ..., "formats": {...}}, or {"missing": why}
  judge.py CLIENT JOBS.json OUT.json   JOBS is a list of jobs, OUT gets a result for each, after each

`doorforge conformance` starts it. A client is the module client_CLIENT.py beside this file: VERSION, FORMATS (format ->
what the loader does beyond loading, for the report) and load(path, format, job) -> an object with

  links() -> {name: mass in kg}, limits() -> {joint: (lower, upper)}
  angle(joint), speed(joint)         of "hinge" and "handle_joint", rad and rad/s
  spring, friction                   of the handle as loaded [N m/rad, N m]: a hand turns against both
  step({joint: torque in N m})       one step of STEP_S with gravity
"""
import importlib
import json
import os
import signal
import sys
import time
import traceback

STEP_S = 0.001
HELD_N = 75.0      # at the handle's distance from the hinge
PULL_N = 50.0
SECONDS = 600      # for one door; after that the process is ended
OPEN_RAD = 0.7853981633974483
GIVES_RAD = 0.0087  # half a degree beyond where the latch held it: the door has given way


class Trial:
    """One loaded door, moved by torques about its two joints."""

    def __init__(self, client, job):
        self.world = client.load(job["path"], job["format"], job)
        self.job, self.time_s = job, 0.0

    def hinge(self):
        return self.world.angle("hinge")

    def handle(self):
        return self.world.angle("handle_joint") if self.job["turns"] else 0.0

    def step(self, hinge_nm, handle_nm=0.0):
        self.world.step({"hinge": hinge_nm, "handle_joint": handle_nm} if self.job["turns"] else {"hinge": hinge_nm})
        self.time_s += STEP_S
        if not abs(self.hinge()) < 1e3:
            raise ArithmeticError("the simulation diverged")

    def run(self, seconds, torques):
        for i in range(round(seconds / STEP_S)):
            yield self.step(*torques(i * STEP_S))

    def turning(self, angle):
        """The torque of a hand that wants the handle there and knows its spring and its friction."""
        speed = self.world.speed("handle_joint")
        ahead = angle - self.handle()
        return self.world.spring * angle + 15 * ahead - 0.06 * speed + (self.world.friction if ahead > 0 else 0)


def held_deg(client, job):
    """The largest hinge angle of the closed door under the load, the handle left alone."""
    trial = Trial(client, job)
    load, worst = HELD_N * job["arm_m"], 0.0
    for _ in trial.run(2.0, lambda t: (load * min(max(t - 0.3, 0) / 0.5, 1),)):
        worst = max(worst, trial.hinge())
        if worst > OPEN_RAD:
            break
    return worst * 57.29577951308232


def unlock_deg(client, job):
    """The handle angle at which the loaded door gives way; None if it does not."""
    trial = Trial(client, job)
    load = 20 * job["arm_m"]
    for _ in trial.run(0.6, lambda t: (load * min(t / 0.2, 1),)):
        pass
    rate, target, held = 0.3, 0.0, trial.hinge()
    while target < job["handle_upper_rad"] + 0.15:
        target += rate * STEP_S
        trial.step(load, trial.turning(target))
        if trial.hinge() > held + GIVES_RAD:
            return trial.handle() * 57.29577951308232
    return None


def open_s(client, job):
    """Seconds to 45 degrees under the pull that grows within a second, the handle kept turned; None if over 5."""
    trial = Trial(client, job)
    turn = trial.world.spring * job["handle_upper_rad"] + trial.world.friction + 1.5
    if job["turns"]:
        for _ in trial.run(1.0, lambda t: (0.0, turn * min(t / 0.8, 1))):
            pass
    pull, start = PULL_N * job["arm_m"], trial.time_s
    for _ in trial.run(5.0, lambda t: (pull * min(t, 1.0), turn)):
        if trial.hinge() >= OPEN_RAD:
            return trial.time_s - start
    return None


def differences(world, job):
    """The largest relative error of masses and the largest error of limits [rad or m]."""
    masses, limits = world.links(), world.limits()
    mass = max((abs(masses[name] / kg - 1) for name, kg in job["masses_kg"].items() if name in masses), default=0.0)
    limit = max((abs(found - told) for name, pair in job["limits"].items() if name in limits
                 for found, told in zip(limits[name], pair)), default=0.0)
    return mass, limit, sorted(set(job["limits"]) - set(limits))


def measure(client, job):
    result = {key: job[key] for key in ("door", "format")}
    start = time.perf_counter()
    try:
        world = client.load(job["path"], job["format"], job)
        mass, limit, lost = differences(world, job)
        result.update(loads=True, mass_error=mass, limit_error=limit, joints_missing=lost)
        result["held_deg"] = held_deg(client, job) if job["latched"] else None
        result["unlock_deg"] = unlock_deg(client, job) if job["latched"] else None
        result["open_s"] = open_s(client, job)
    except Exception as problem:  # whatever an engine says of a file is a row of the table
        result.setdefault("loads", False)
        result["problem"] = f"{type(problem).__name__}: {problem}".splitlines()[0][:300]
        if os.environ.get("DOORFORGE_CONFORMANCE_TRACE"):
            traceback.print_exc()
    result["seconds"] = time.perf_counter() - start
    return result


def write(path, record):
    """The file is there as a whole or not at all."""
    with open(path + ".part", "w", encoding="utf-8") as file:
        json.dump(record, file)
    os.replace(path + ".part", path)


def probe(name):
    try:
        client = importlib.import_module("client_" + name)
    except ImportError as missing:
        return {"missing": f"{missing}".splitlines()[0]}
    return {"version": client.VERSION, "formats": client.FORMATS}


def main():
    os.dup2(2, 1)  # engines print as they load; what is on standard output belongs to doorforge
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    if sys.argv[2] == "--probe":
        write(sys.argv[3], probe(sys.argv[1]))
        return 0
    client = importlib.import_module("client_" + sys.argv[1])
    with open(sys.argv[2], encoding="utf-8") as file:
        jobs = json.load(file)
    results = []
    for job in jobs:
        signal.alarm(SECONDS)
        results.append(measure(client, job))
        signal.alarm(0)
        write(sys.argv[3], {"version": client.VERSION, "formats": client.FORMATS, "results": results})
    return 0


if __name__ == "__main__":
    sys.exit(main())

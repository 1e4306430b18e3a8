"""Runs the conversions of docs/logs.md on files made here, and reads what they write.

Each block ```python FORM of the page and the block ```sh behind it are run as they stand in a folder of
their own that holds a file of that form; the figures must be those of the numbers that were put in.

usage: python run.py FOGBENCH
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

PAGE = Path(__file__).parents[2] / "docs" / "logs.md"
RATE_HZ = 100
RATES = numpy.random.default_rng(1).normal(2e-4, 1e-3, 6000)  # rad/s
STAMPS = 1_700_000_000_000_000_000 + numpy.arange(RATES.size) * (10**9 // RATE_HZ)  # ns
DEG_PER_H = numpy.degrees(3600.0)


def make_mat(folder):
    import scipy.io

    scipy.io.savemat(folder / "log.mat", {"gyro": RATES})


def make_hdf5(folder):
    import h5py

    with h5py.File(folder / "log.h5", "w") as file:
        file["imu/gyro_z"] = RATES


def make_miniseed(folder):
    import obspy

    trace = obspy.Trace(RATES, {"sampling_rate": RATE_HZ})
    obspy.Stream([trace]).write(str(folder / "log.mseed"), format="MSEED", encoding="FLOAT64")


def make_mcap(folder):
    from mcap.writer import Writer

    with open(folder / "log.mcap", "wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("Imu", "jsonschema", b'{"type": "object"}')
        channel = writer.register_channel("/imu", "json", schema)
        for stamp, rate in zip(STAMPS.tolist(), RATES.tolist()):
            data = json.dumps({"gyro_z": rate}).encode()
            writer.add_message(channel, log_time=stamp, publish_time=stamp, data=data)
        writer.finish()


def make_ros(folder):
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    types = store.types
    vector, turn = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Quaternion"]
    nothing = numpy.zeros(9)
    with Writer(folder / "log.bag") as writer:
        imu = types["sensor_msgs/msg/Imu"]
        channel = writer.add_connection("/imu", imu.__msgtype__, typestore=store)
        for index, (stamp, rate) in enumerate(zip(STAMPS.tolist(), RATES.tolist())):
            time = types["builtin_interfaces/msg/Time"](stamp // 10**9, stamp % 10**9)
            message = imu(
                types["std_msgs/msg/Header"](index, time, "imu"),
                turn(0.0, 0.0, 0.0, 1.0),
                nothing,
                vector(0.0, 0.0, rate),
                nothing,
                vector(0.0, 0.0, 9.8),
                nothing,
            )
            data = store.serialize_ros1(message, imu.__msgtype__)
            writer.write(channel, stamp, data)


MAKERS = {
    "mat": make_mat,
    "hdf5": make_hdf5,
    "miniseed": make_miniseed,
    "mcap": make_mcap,
    "ros": make_ros,
}


def convert(fogbench, form, lines, command):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        MAKERS[form](folder)
        subprocess.run([sys.executable, "-c", lines], cwd=folder, check=True)
        arguments = command.split()
        assert arguments.pop(0) == "fogbench", command
        done = subprocess.run(
            [fogbench, *arguments, "--format", "json"], cwd=folder, stdout=subprocess.PIPE, check=True
        )
    found = json.loads(done.stdout)
    log, raw = found["log"], found["channels"]["raw"]
    assert log["samples"] == RATES.size, log
    assert abs(log["rate_hz"] - RATE_HZ) < 1e-6, log
    for key, wanted in [
        ("mean_deg_per_h", RATES.mean() * DEG_PER_H),
        ("maximum_deg_per_h", RATES.max() * DEG_PER_H),
    ]:
        value = raw[key]["value"]
        assert abs(value - wanted) < 1e-9 * abs(wanted) + 1e-9, (key, value, wanted)
    print(f"{form}: {log['samples']} samples at {log['rate_hz']} Hz, mean and maximum as they were put in")


def main():
    fogbench = str(Path(sys.argv[1]).resolve())
    pattern = r"```python (\w+)\n(.*?)```\n+```sh\n(fogbench .*?)\n```"
    blocks = re.findall(pattern, PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert {form for form, _, _ in blocks} == set(MAKERS), "each form has its lines, and no other"
    for form, lines, command in blocks:
        convert(fogbench, form, lines, command)


if __name__ == "__main__":
    main()

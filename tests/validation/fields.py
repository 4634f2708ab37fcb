"""Fields of a run as NetCDF, compared with those of the same run as arrays of NumPy.

Argument: a directory with the runs `npy` and `netcdf`. Leaves `python.npz` there, made of the last fields.
"""

import json
import sys
from pathlib import Path

import numpy as np

root = Path(sys.argv[1])
run = json.loads((root / "netcdf" / "run.json").read_text())
NAMES = ["depth", "velocity_x", "velocity_y", "vorticity", "potential_vorticity", "speed"]
STANDARD = {"depth": "sea_floor_depth_below_sea_surface", "velocity_x": "sea_water_x_velocity", "potential_vorticity": None}


def expected(name, number):
    # Of these arrays the first index is that of x.
    return np.load(root / "npy" / (f"{name}-{number:06}.npy" if number else f"{name}.npy")).T


def compare(reader, number, values, coordinates):
    for name in NAMES:
        assert np.array_equal(values(name), expected(name, number)), f"{reader}: {name}"
    time, y, x = coordinates
    steps = {frame["number"]: frame["step"] for frame in run["numbered"]}
    step = steps[number] if number else run["steps"]
    assert np.allclose(time, [step * run["scene"]["time"]["step"]], rtol=1e-14), (reader, time)
    for axis, nodes in enumerate([x, y]):
        spacing = run["mesh"]["spacing"][axis]
        assert np.allclose(nodes, np.arange(run["mesh"]["nodes"][axis]) * spacing, rtol=1e-14), reader
    print(f"{reader}, frame {number or 'at the end'}: {len(NAMES)} fields are equal to the last bit")


def by_scipy():
    import scipy
    from scipy.io import netcdf_file

    for number in [0, 1, 3]:
        name = f"fields-{number:06}.nc" if number else "fields.nc"
        with netcdf_file(root / "netcdf" / name, mmap=False) as file:
            values = lambda name: file.variables[name][0]
            compare(f"scipy {scipy.__version__}", number, values, [file.variables[name][:] for name in ["time", "y", "x"]])
            assert file.Conventions == b"CF-1.11" and file.title.decode() == run["scene"]["title"]
            assert file.coriolis_parameter == run["scene"]["interactions"][0]["rotation"]
            assert np.isclose(file.gravity * file.mean_depth, run["scene"]["interactions"][0]["wave_speed"] ** 2)


def by_netcdf():
    import netCDF4

    with netCDF4.Dataset(root / "netcdf" / "fields.nc") as file:
        assert file.data_model == "NETCDF3_64BIT_OFFSET" and file.dimensions["time"].isunlimited()
        compare(f"netCDF4 {netCDF4.__version__}", 0, lambda name: file[name][0].data, [file[name][:].data for name in ["time", "y", "x"]])
        for name, standard in STANDARD.items():
            assert getattr(file[name], "standard_name", None) == standard and file[name].units == "1"
        assert [file[name].axis for name in ["time", "y", "x"]] == ["T", "Y", "X"]


def by_xarray():
    import xarray

    names = [root / "netcdf" / f"fields-{number:06}.nc" for number in [1, 2, 3]]
    with xarray.open_mfdataset(names) as joined:
        assert joined.depth.dims == ("time", "y", "x") and joined.sizes["time"] == 3
        for place, number in enumerate([1, 2, 3]):
            frame = joined.isel(time=[place])
            compare(f"xarray {xarray.__version__}", number, lambda name: frame[name].values[0], [frame[name].values for name in ["time", "y", "x"]])


def floats():
    """The paths of floats by the code of the page on floats are the integrals of their velocities."""
    import os

    page = (Path(__file__).parents[2] / "docs/models/shallow-water-starts.md").read_text()
    os.chdir(root)
    found = {}
    exec(page.split("```python\n")[1].split("```")[0], found)
    paths = found["paths"]
    with found["gsd"].hoomd.open("shallow-water/trajectory.gsd") as frames:
        velocity = np.array([frame.particles.velocity[-4:, :2] for frame in frames])
    assert paths.shape == (401, 4, 2)
    travelled = paths - paths[0]
    # Velocities of full steps: the trapezoidal rule.
    integral = np.concatenate([[np.zeros((4, 2))], np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * 0.02, axis=0)])
    apart, longest = np.abs(travelled - integral).max(), np.abs(travelled).max()
    assert longest > 0.3 and apart < 0.01 * longest, (apart, longest)
    print(f"floats: paths of up to {longest:.2f}, at most {apart:.1e} from the integrals of their velocities")


np.savez_compressed(root / "python.npz", h=expected("depth", 0).T, u=expected("velocity_x", 0).T.astype(">f8"), v=expected("velocity_y", 0).T)
for module, compare_by in [("scipy", by_scipy), ("netCDF4", by_netcdf), ("xarray", by_xarray), ("gsd", floats)]:
    try:
        __import__(module)
    except ImportError:
        print(f"NOT TESTED: {module} cannot be installed")
        continue
    compare_by()

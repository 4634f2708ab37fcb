"""Scenes, runs, sweeps and what they leave."""

import json

import mesoscope as ms
import numpy as np
import pytest


def test_a_dictionary_is_a_scene(small):
    scene = ms.scene("dpd-fluid")
    scene["particles"][0]["mass"] = np.float32(2)
    scene["space"]["box"], scene["output"] = np.array([4, 4, 4]), {}
    assert ms.check(scene)["scene"]["particles"][0]["mass"] == 2
    with open("mine.json", "w") as file:
        json.dump(ms.scene(scene), file)
    assert ms.check("mine.json")["particles"] == 192
    assert ms.check("mine.json", time=True)["seconds"] > 0
    assert {"dpd-fluid", "shallow-water"} <= set(ms.scenes()) and ms.schema()["properties"]["space"]
    assert ms.adapters()[0]["name"]


def test_all_mistakes_are_named_at_once():
    scene = ms.scene("dpd-fluid")
    scene["temprature"] = 1
    scene["time"]["step"] = -1
    with pytest.raises(ms.SceneError) as found:
        ms.check(scene)
    assert dict(found.value.mistakes)["temprature"].startswith("unknown key; did you mean `temperature`?")
    assert "time.step" in dict(found.value.mistakes)
    scene["time"]["step"], scene["seed"] = float("nan"), object()
    with pytest.raises(ms.SceneError) as found:
        ms.check(scene)
    assert {place for place, _ in found.value.mistakes} == {"time.step", "seed"}
    with pytest.raises(ms.SceneError, match="did you mean `dpd-fluid`"):
        ms.scene("dpd-fluit")


def test_a_run_has_means_tables_and_pictures(small):
    output = {
        "energies": {"every": 5},
        "trajectory": {"every": 50},
        "radial_distribution": {"every": 20, "bins": 40, "range": 2, "species": "all-pairs"},
        "diffusion": {"every": 2, "window": 40, "species": "A"},
        "plot": {"width": 400},
        "snapshot": {"width": 100},
    }
    groups = [{"species": name, "count": 96} for name in "AB"]
    seen = []
    run = ms.run("dpd-fluid", small | {"particles": groups, "output": output}, out="run", steps=200, progress=seen.append)
    assert [event["event"] for event in seen[:2]] == ["compiling", "started"] and any(event["event"] == "progress" for event in seen)
    temperature = run.mean("temperature")
    assert temperature.value == pytest.approx(1, abs=0.2) and temperature.error > 0 and temperature.unit
    assert "±" in str(temperature)
    assert run.energies["temperature"].shape == (41,) and np.isfinite(run.energies["pressure"]).all()
    own, other = run.rdf("A", "A"), run.rdf("B", "A")
    assert own["g"].shape == own["distance"].shape == own["error"].shape and not (own["g"] == other["g"]).all()
    with pytest.raises(ms.ArrayError, match="name one of these pairs"):
        run.rdf("A", "C")
    everything = ms.run("dpd-fluid", small | {"output": {"radial_distribution": {"every": 20, "bins": 40, "range": 2}}}, out="g", steps=60, progress=False)
    assert everything.rdf().keys() == {"distance", "g", "error"}
    assert run.diffusion("A").value > 0
    with pytest.raises(ms.ArrayError, match="set output.diffusion.species"):
        run.diffusion("B")
    assert run.trajectory(unwrap=True).shape == (5, 192, 3)
    assert run.plot()._repr_png_().startswith(b"\x89PNG")
    with pytest.raises(ms.ArrayError, match="accepted: .*energies"):
        run.plot("energy")
    with pytest.raises(ms.ArrayError, match="accepted: .*temperature"):
        run.mean("temprature")
    page = run._repr_html_()
    assert page.startswith("<h3>") and "data:image/png" in page
    assert ms.open("run").means.keys() == run.means.keys()
    with pytest.raises(ms.FileError, match="contains|exists|--force"):
        ms.run("dpd-fluid", small, out="run", steps=10, progress=False)
    assert ms.run("dpd-fluid", small, out="run", steps=10, force=True, pictures=False, progress=False).steps == 10


def test_titles_are_escaped(small):
    run = ms.run("dpd-fluid", small | {"title": "<script>alert(1)</script>"}, out="run", steps=5, progress=False)
    assert "<script>" not in run._repr_html_()


def test_fields_are_arrays(place):
    water = {
        "interactions.0.mesh": [16, 16], "particles.0.count": 4096, "interactions.0.smoothing.length": 0.8,
        "output.fields": {"quantities": ["depth", "speed"], "every": 5},
    }  # fmt: skip
    run = ms.run("shallow-water", water, out="water", steps=10, progress=False)
    # Steps 5 and 10 have numbers, or 0 too, and the end is step 10.
    times = run.field_times.tolist()
    assert times == sorted(set(times)) and times[-1] == pytest.approx(10 * run.scene["time"]["step"])
    assert run.fields["depth"].shape == (len(times), 16, 16)
    assert not any((one == other).all() for one, other in zip(run.fields["speed"], run.fields["speed"][1:]))
    xarray = pytest.importorskip("xarray")
    found = run.to_xarray()
    assert isinstance(found, xarray.Dataset) and found["depth"].dims == ("x", "y")


def test_a_sweep_is_a_table(small):
    found = ms.sweep("dpd-fluid", {"interactions.0.friction": [2, 8]}, small, seeds=3, steps=60, out="sweep", progress=False)
    table = found.table()
    assert table["friction" if "friction" in table else "interactions.0.friction"].tolist() == [2, 2, 2, 8, 8, 8]
    assert len(found.runs()) == 6 and not found.failures
    assert len(found.averages()["seeds"]) == 2
    assert len(pytest.importorskip("pandas") and found.to_pandas()) == 6
    assert ms.open("sweep").table().keys() == table.keys()
    scene = ms.scene("dpd-fluid")
    again = ms.sweep(scene, {}, small, seeds=[3, 4], steps=20, out="seeds", progress=False)
    assert len(again.runs()) == 2
    with pytest.raises(ms.SceneError, match="nothing is varied"):
        ms.sweep(scene, {})


def test_a_stage_has_what_its_analyses_found(small):
    measured = {"radial_distribution": {"every": 5, "range": 1.5}, "diffusion": {"every": 4, "window": 20, "species": "fluid"}}
    stages = [{"steps": 20}, {"steps": 300, "output": measured}, {"steps": 300, "output": measured}]
    run = ms.run("dpd-fluid", small | {"time": {"step": 0.04}, "stages": stages}, out="staged", progress=False)
    earlier = run.stage(2)
    assert earlier.rdf()["g"].shape == run.rdf()["g"].shape and earlier.steps == 320 and run.steps == 620
    assert earlier.diffusion("fluid").value > 0 and run.diffusion("fluid").value > 0
    assert run.summary["stages"][1]["results"] == earlier.results
    with pytest.raises(ms.ArrayError, match="stage 1 of this run has no analyses of its own; accepted: 2"):
        run.stage(1)


def test_what_is_missing_or_damaged_is_named(place, small):
    with pytest.raises(ms.FileError, match="has no run.json"):
        ms.open("nothing")
    ms.run("dpd-fluid", small, out="run", steps=20, progress=False)
    table = place / "run" / "energies.csv"
    table.write_text(table.read_text()[:-7])
    with pytest.raises(ms.FileError, match="line [0-9]+: found"):
        ms.open("run").energies
    (place / "run" / "run.json").write_text("{")
    with pytest.raises(ms.FileError, match="no summary of a run"):
        ms.open("run")


def test_a_tradeoff_says_what_to_choose(small):
    settings = small | {"output": {"energies": {"every": 5}}}
    found = ms.tradeoff(
        "dpd-fluid", {"time.step": [0.02, 0.08]}, {"temperature": "50%"}, settings, "tradeoff",
        measures=["temperature"], seeds=2, steps=200, progress=False,
    )  # fmt: skip
    assert "Every choice ran with 2 seeds" in found.page and found.table()["seeds"].tolist() == [2, 2]
    assert found.scene["time"]["step"] in (0.02, 0.08) and "Choose" in found.advice
    assert "# What accuracy costs" in found.page and len(found.table()["choice"]) == 2 and found.plots()
    assert isinstance(ms.open("tradeoff"), ms.Tradeoff)
    with pytest.raises(ms.SceneError, match="accepted: .*temperature"):
        ms.tradeoff("dpd-fluid", {"time.step": [0.02]}, {"temprature": "1%"}, settings)


def test_a_map_says_how_far_a_scene_may_go(small):
    settings = small | {"output": {"energies": {"every": 5}}}
    found = ms.stability("dpd-fluid", {"time.step": "0.02..2/3"}, settings, "map", bisections=1, seeds=2, steps=200, progress=False)
    assert "Means are over 2 seeds, with errors from their scatter." in found.page
    assert found.rows[0]["unstable_from"] != "not seen" and len(found.table()["verdict"]) >= 3
    assert isinstance(ms.open("map"), ms.Stability)


def test_a_page_is_made_of_results(small):
    run = ms.run("dpd-fluid", small | {"title": "<i>"}, out="run", steps=20, progress=False)
    page = ms.report(run, out="page.html")
    assert "&lt;i&gt;" in page.path.read_text() and page._repr_html_().startswith("<iframe")
    with pytest.raises(ms.FileError, match="exists; give another name"):
        ms.report("run", out="page.html")
    with pytest.raises(ms.FileError, match="there is no such directory"):
        ms.report("nothing", out="other.html")

#!/usr/bin/python3
"""Says what VTK reads in .vtu and .pvd files, as JSON, so that the tests of the writer are judged by the program the files are for.

judge_vtu.py [--values] FILE...   one JSON object per file, in a list

.vtu: "points", "cells" {VTK type: {"count", "nodes": [node counts that occur]}}, "point_data" and "cell_data" {name: components}, "time",
      "measure" {dimension: integral of 1}, "moment" {dimension: integral of x^2 y z} over the cells as VTK's shape functions bend them,
      "meshio" what meshio reads: {"points", "cells", "arrays", "same": whether its point data are VTK's bit for bit},
      "integrals" {array: [integral of every component]}, "formats" (of all DataArrays), "compressor", and with --values "values" {array: [...]}.
.pvd: "entries" [{"timestep", "part", "name", "file", "vtu": as above}].
Numbers that are not finite are null. VTK's complaints make the program fail.
"""
import itertools
import json
import math
import os
import sys
import xml.etree.ElementTree

import meshio
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkUnstructuredGrid
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

DIMENSION = {1: 0, 68: 1, 69: 2, 70: 2, 71: 3, 72: 3}
SIMPLEX = {69, 71}
EXPONENTS = (2, 1, 1)


def quadrature(kind, points=11):
    """Gauss rule on VTK's reference cell; on simplices through the collapsed square or cube."""
    x, w = numpy.polynomial.legendre.leggauss(points)
    x, w = (x + 1) / 2, w / 2
    dim = DIMENSION[kind]
    rule = []
    for index in itertools.product(range(points), repeat=dim):
        xi = [x[i] for i in index]
        weight = float(numpy.prod([w[i] for i in index]))
        if kind in SIMPLEX:
            shrink = 1.0
            for a in range(dim):
                xi[a] *= shrink
                weight *= shrink
                shrink = shrink - xi[a]
        rule.append((xi + [0.0] * (3 - dim), weight))
    return rule


class Shapes:
    """VTK's own shape functions of a kind of cell with n nodes, at the points of a quadrature rule."""

    def __init__(self, kind, n):
        grid, points, ids = vtkUnstructuredGrid(), vtkPoints(), vtkIdList()
        for i in range(n):
            points.InsertNextPoint(0, 0, 0)
            ids.InsertNextId(i)
        grid.SetPoints(points)
        grid.InsertNextCell(kind, ids)
        cell = grid.GetCell(0)

        def value(xi):
            weights = [0.0] * n
            cell.InterpolateFunctions(xi, weights)
            return numpy.array(weights)

        def derivative(xi, a, h=0.25):  # exact for polynomials up to degree 4
            def at(s):
                return value([x + (s * h if b == a else 0.0) for b, x in enumerate(xi)])

            return (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)

        rule = quadrature(kind)
        self.weights = [w for _, w in rule]
        self.values = [value(xi) for xi, _ in rule]
        self.gradients = [[derivative(xi, a) for a in range(DIMENSION[kind])] for xi, _ in rule]


SHAPES = {}


def shapes(kind, n):
    if (kind, n) not in SHAPES:
        SHAPES[kind, n] = Shapes(kind, n)
    return SHAPES[kind, n]


def measures(tangents):
    """Length, area or volume of the parallelepipeds spanned by the tangents, [cell][3] each."""
    j = numpy.stack(tangents, axis=1)
    return numpy.sqrt(numpy.maximum(0, numpy.linalg.det(j @ j.transpose(0, 2, 1))))


def read(path, with_values):
    complaints = []
    reader = vtkXMLUnstructuredGridReader()
    reader.AddObserver("ErrorEvent", lambda *_: complaints.append("error"))
    reader.AddObserver("WarningEvent", lambda *_: complaints.append("warning"))
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    root = xml.etree.ElementTree.parse(path).getroot()
    facts = {
        "points": grid.GetNumberOfPoints(),
        "cells": {},
        "measure": {},
        "moment": {},
        "integrals": {},
        "formats": sorted({a.get("format") for a in root.iter("DataArray")}),
        "compressor": root.get("compressor"),
        "appended": root.find("AppendedData") is not None,
        "time": vtk_to_numpy(grid.GetFieldData().GetArray("TimeValue")).tolist(),
    }
    point_data = {a.GetName(): a for a in (grid.GetPointData().GetArray(i) for i in range(grid.GetPointData().GetNumberOfArrays()))}
    cell_data = {a.GetName(): a for a in (grid.GetCellData().GetArray(i) for i in range(grid.GetCellData().GetNumberOfArrays()))}
    facts["point_data"] = {name: a.GetNumberOfComponents() for name, a in point_data.items()}
    facts["cell_data"] = {name: a.GetNumberOfComponents() for name, a in cell_data.items()}
    values = {name: vtk_to_numpy(a).reshape(-1, a.GetNumberOfComponents()) for name, a in (point_data | cell_data).items()}
    x = vtk_to_numpy(grid.GetPoints().GetData()).astype(float)
    other = meshio.read(path)  # a reader that knows VTK's format from its documentation
    facts["meshio"] = {
        "points": len(other.points),
        "cells": sum(len(block.data) for block in other.cells),
        "same": all(numpy.array_equal(a.reshape(-1), values[name].reshape(-1), equal_nan=True) for name, a in other.point_data.items()),
        "arrays": sorted(other.point_data),
    }
    if with_values:
        facts["values"] = {name: v.ravel().tolist() for name, v in values.items()} | {"points": x.ravel().tolist()}

    kinds = {}
    for c in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(c)
        ids = [cell.GetPointId(i) for i in range(cell.GetNumberOfPoints())]
        kinds.setdefault((grid.GetCellType(c), len(ids)), []).append((c, ids))
    for (kind, n), cells in sorted(kinds.items()):
        entry = facts["cells"].setdefault(str(kind), {"count": 0, "nodes": []})
        entry["count"] += len(cells)
        entry["nodes"].append(n)
        dim = DIMENSION[kind]
        if dim == 0:
            continue
        numbers = numpy.array([c for c, _ in cells])
        nodes = numpy.array([ids for _, ids in cells])
        shape = shapes(kind, n)
        for w, value, gradient in zip(shape.weights, shape.values, shape.gradients):
            weight = w * measures([numpy.einsum("i,cij->cj", g, x[nodes]) for g in gradient])
            place = numpy.einsum("i,cij->cj", value, x[nodes])
            monomial = numpy.prod([place[:, i] ** e for i, e in enumerate(EXPONENTS)], axis=0)
            facts["measure"][str(dim)] = facts["measure"].get(str(dim), 0.0) + float(weight.sum())
            facts["moment"][str(dim)] = facts["moment"].get(str(dim), 0.0) + float((weight * monomial).sum())
            for name in values:
                at = numpy.einsum("i,cij->cj", value, values[name][nodes]) if name in point_data else values[name][numbers]
                before = numpy.array(facts["integrals"].get(name, [0.0] * values[name].shape[1]))
                facts["integrals"][name] = (before + weight @ at).tolist()
    if complaints:
        sys.exit(f"VTK complains about {path}")
    return facts


def read_collection(path, with_values):
    root = xml.etree.ElementTree.parse(path).getroot()
    entries = []
    for d in root.find("Collection"):
        file = os.path.join(os.path.dirname(path), d.get("file"))
        entries.append({"timestep": float(d.get("timestep")), "part": int(d.get("part")), "name": d.get("name"), "file": d.get("file"),
                        "vtu": read(file, with_values)})
    return {"entries": entries}


def finite(facts):
    if isinstance(facts, dict):
        return {key: finite(value) for key, value in facts.items()}
    if isinstance(facts, list):
        return [finite(value) for value in facts]
    return None if isinstance(facts, float) and not math.isfinite(facts) else facts


def main(arguments):
    with_values = "--values" in arguments
    files = [a for a in arguments if a != "--values"]
    print(json.dumps(finite([(read_collection if f.endswith(".pvd") else read)(f, with_values) for f in files]), allow_nan=False))


main(sys.argv[1:])

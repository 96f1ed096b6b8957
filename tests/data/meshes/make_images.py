# SPDX-License-Identifier: AGPL-3.0-or-later
"""Writes the files of the folder images by nibabel: a ball (1) with a smaller one (5) inside, on an oblique grid.

Usage: make_images.py FOLDER
"""
import sys
from pathlib import Path

import nibabel
import numpy

folder = Path(sys.argv[1]) / "images"
i, j, k = numpy.meshgrid(numpy.arange(14), numpy.arange(12), numpy.arange(10), indexing="ij")
spacing = numpy.array([1.5, 2.0, 2.5])
centre = numpy.array([6, 5, 4])
square = sum(((index - c) * s) ** 2 for index, c, s in zip((i, j, k), centre, spacing))
labels = numpy.where(square < 3.1 ** 2, 5, numpy.where(square < 7.9 ** 2, 1, 0))

angle = 0.4
turn = numpy.array([[numpy.cos(angle), -numpy.sin(angle), 0], [numpy.sin(angle), numpy.cos(angle), 0], [0, 0, 1]])
affine = numpy.eye(4)
affine[:3, :3] = turn @ numpy.diag(spacing * [1, 1, -1])
affine[:3, 3] = [10, -20, 30]

image = nibabel.Nifti1Image(labels.astype(numpy.uint8), affine)
image.header.set_xyzt_units("mm")
image.set_qform(affine, code=0)
nibabel.save(image, folder / "ball_sform.nii.gz")

header = nibabel.Nifti1Header(endianness=">")
header.set_data_dtype(numpy.int16)
image = nibabel.Nifti1Image(labels.astype(">i2"), affine, header)
image.header.set_xyzt_units("mm")
image.set_sform(affine, code=0)
image.set_qform(affine, code=1)
nibabel.save(image, folder / "ball_qform.nii")

labels.astype(numpy.uint16).flatten(order="F").tofile(folder / "ball.raw")
for name in ("ball_sform.nii.gz", "ball_qform.nii"):
    found = nibabel.load(folder / name)
    print(name, "voxel (6, 5, 4) at", found.affine @ [6, 5, 4, 1], "voxel (13, 0, 9) at", found.affine @ [13, 0, 9, 1],
          "ones", (found.get_fdata() == 1).sum(), "fives", (found.get_fdata() == 5).sum())
dirs = " ".join("(" + ",".join(repr(float(x)) for x in affine[:3, a]) + ")" for a in range(3))
print(f"teem-unu make -i ball.raw -t ushort -s 14 12 10 -e raw -en little -spc right-anterior-superior "
      f"-orig '(10,-20,30)' -dirs '{dirs}' | teem-unu save -f nrrd -e gzip -o ball_gzip.nrrd")

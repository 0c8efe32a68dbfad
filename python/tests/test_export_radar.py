# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
"""Tests the exporters to CARRADA and RADIal: the spectra against the maps of the engine, the axes against the
van ahead, the files against what the published loaders expect."""

import csv
import json
import pathlib
import tempfile
import unittest

import numpy as np

import greatx
import support
from greatx.convert.poses import Pose, sensor_pose
from greatx.convert.radar import write_carrada, write_radial
from greatx.convert.radar.carrada import annotation
from greatx.convert.radar.source import detections
from greatx.convert.radar.spectrum import axes_of, beams, noise_bandwidth, spectrum, window
from greatx.links import rotation


class Exported(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.out = pathlib.Path(holder.name, "out")
        self.ds = greatx.load(support.rig())
        self.radar = self.ds.sequences[0]["car/radar"]

    def van(self, record):
        """Returns the van's centre in the radar's frame (x forward, y left, z up)."""
        camera = self.ds.sequences[0]["car/front"].at(record.tick)
        number = [i for i, node in enumerate(camera.box_node) if node == 2][0]
        return sensor_pose(record).inverse().apply(camera.box_center[number])


class Spectrum(Exported):
    def test_maps_are_those_of_the_engine(self):
        axes = axes_of(self.radar)
        for record in self.radar:
            values = spectrum(np.asarray(record.cube), "hann")
            power = np.mean(np.abs(values) ** 2, axis=(0, 1))
            np.testing.assert_allclose(power, record.range_doppler, rtol=1e-4)
            over = beams(values, self.radar, axes.azimuth_rad).sum(axis=2)
            over /= noise_bandwidth(window("hann", values.shape[3]))
            np.testing.assert_allclose(over, record.range_azimuth, atol=1e-6 * over.max())
        self.assertAlmostEqual(noise_bandwidth(window("blackman", 64)), 1.727, 3)
        self.assertAlmostEqual(noise_bandwidth(window("hamming", 64)), 1.363, 3)


class Carrada(Exported):
    def test_maps_and_annotations(self):
        counts = write_carrada(self.ds, self.out, pictures=False)
        self.assertEqual((counts["sequences"], counts["frames"], counts["angle-Doppler maps"]), (2, 4, 4))
        folder = self.out / "sequence_0000"
        axes = json.loads((folder / "axes.json").read_text())
        frames = json.loads((self.out / "annotations_frame_oriented.json").read_text())["sequence_0000"]
        for number, record in enumerate(self.radar):
            frame = f"{number:06d}"
            maps = {
                view: np.load(folder / f"{view}_raw" / f"{frame}.npy")
                for view in ("range_doppler", "range_angle", "angle_doppler")
            }
            np.testing.assert_array_equal(maps["range_doppler"], record.range_doppler)
            np.testing.assert_array_equal(maps["range_angle"], record.range_azimuth[::-1, ::-1])
            self.assertEqual(maps["angle_doppler"].shape, (181, 32))
            processed = np.load(folder / "range_doppler_processed" / f"{frame}.npy")
            np.testing.assert_allclose(processed, 10 * np.log10(1000 * record.range_doppler), rtol=1e-5)
            # The sums over velocities of both maps of angles, over all ranges, are one thing.
            sums = maps["angle_doppler"].sum(axis=1) / noise_bandwidth(window("hann", 32))
            # Sidelobes are differences of larger single-precision numbers.
            expected = maps["range_angle"].sum(axis=0)
            rounding = np.finfo(np.float32).eps * expected.max()
            np.testing.assert_allclose(sums, expected, rtol=1e-4, atol=rounding)
            # The van is the only vehicle ahead; its back is 2.4 m before its centre.
            (instance,) = frames[frame]
            self.assertEqual(self.ds.instances[int(instance) - 1]["class"], "vehicle")
            x, y, _ = self.van(record)
            doppler, angle = (frames[frame][instance][view] for view in ("range_doppler", "range_angle"))
            row, column = doppler["sparse"][0]
            self.assertLess(abs(axes["range_doppler"]["rows_range_m"][row] - (np.hypot(x, y) - 2.4)), 1.0)
            row, column = angle["sparse"][0]
            self.assertLess(abs(axes["range_angle"]["rows_range_m"][row] - (np.hypot(x, y) - 2.4)), 1.0)
            right = np.array(axes["range_angle"]["columns_angle_right_rad"])
            self.assertLess(abs(right[column] - np.arctan2(-y, x)), np.radians(8))
            (azimuth,) = {d.azimuth_rad for d in detections(record) if d.instance == int(instance)}
            self.assertLessEqual(abs(right[column] + azimuth), (right[1] - right[0]) / 2 + 1e-9)
            for form in ("sparse", "box", "dense"):
                for view, part in (("range_doppler", doppler), ("range_angle", angle)):
                    mask = np.load(folder / "annotations" / form / frame / f"{view}.npy")
                    self.assertEqual(mask.shape, (4, *maps[view].shape))
                    np.testing.assert_array_equal(mask.sum(axis=0), 1)
                    self.assertEqual(mask[[1, 2]].sum(), 0)
                    if form != "box":
                        self.assertEqual(sorted(map(tuple, part[form])), list(zip(*np.nonzero(mask[3]))))
        reference = json.loads((self.out / "data_seq_ref.json").read_text())
        self.assertEqual(
            reference["sequence_0001"], {"split": "Train", "instances": [instance], "labels": [3]}
        )
        light = json.loads((self.out / "light_dataset_frame_oriented.json").read_text())
        self.assertEqual(light["sequence_0000"], ["000000", "000001"])
        instances = json.loads((self.out / "annotations_instance_oriented.json").read_text())
        self.assertEqual(instances["sequence_0000"][instance]["000001"], frames["000001"][instance])

    def test_an_annotation(self):
        part = annotation([(2, 5), (2, 9), (2, 5)], (20, 11), 3)
        self.assertEqual((part["sparse"], part["box"]), ([[2, 5], [2, 9]], [[1, 5], [3, 9]]))
        dense = set(map(tuple, part["dense"]))
        self.assertTrue({(0, 5), (4, 5), (4, 6), (2, 3), (2, 10)} <= dense)
        # Below 3 cells: (2, 2) is at sqrt(8), (3, 0) is not near. Cells beyond the map are left out.
        self.assertIn((4, 7), dense)
        self.assertTrue({(5, 5), (2, 12), (2, 11)}.isdisjoint(dense))

    def test_errors(self):
        with self.assertRaisesRegex(greatx.DatasetError, "expected a radar, found poses, csi"):
            write_carrada(greatx.load(support.space()), self.out)
        with self.assertRaisesRegex(greatx.DatasetError, "several cameras.*--camera.*car/front, car/right"):
            write_carrada(self.ds, self.out)
        with self.assertRaisesRegex(greatx.DatasetError, "label of pedestrian, cyclist, car, found 'boat'"):
            write_carrada(self.ds, self.out, classes={"vehicle": "boat"}, pictures=False)
        with self.assertRaisesRegex(greatx.DatasetError, "'boat/radar'; there are car/radar"):
            write_carrada(self.ds, self.out, radar="boat/radar")
        self.assertFalse(self.out.exists())


class Radial(Exported):
    def test_samples_and_labels(self):
        counts = write_radial(self.ds, self.out, camera="car/front", pictures=False)
        self.assertEqual((counts["samples"], counts["labels"]), (4, 4))
        with open(self.out / "labels.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for number, record in enumerate(self.radar):
            row = rows[number]
            self.assertEqual(
                (row["numSample"], row["dataset"], row["index"], row["Difficult"]),
                (str(number), "sequence_0000", str(number), "0"),
            )
            x, y, _ = self.van(record)
            values = {key: float(value) for key, value in row.items() if key not in ("dataset",)}
            # X is to the left and Y forward, and the angle grows to the left.
            self.assertAlmostEqual(values["radar_X_m"], y, 9)
            self.assertAlmostEqual(values["radar_Y_m"], x, 9)
            self.assertAlmostEqual(values["radar_R_m"] * np.sin(np.radians(values["radar_A_deg"])), y, 9)
            camera = self.ds.sequences[0]["car/front"].at(record.tick)
            box = [values[k] for k in ("x1_pix", "y1_pix", "x2_pix", "y2_pix")]
            np.testing.assert_allclose(box, camera.box_amodal[list(camera.box_node).index(2)], rtol=1e-6)
            # The LiDAR is turned by 10 degrees; the end that it sees is the van's back.
            lidar = sensor_pose(self.ds.sequences[0]["car/lidar"].at(record.tick))
            van = list(camera.box_node).index(2)
            back = Pose(camera.box_center[van], rotation(camera.box_orientation[van]))
            back = back.apply(np.array([-camera.box_size[van][0] / 2, 0, 0]))
            laser = [values[f"laser_{k}_m"] for k in "XYZ"]
            np.testing.assert_allclose(lidar.apply(np.array(laser)), back, atol=1e-6)
            spectra = np.load(self.out / "radar_FFT" / f"fft_{number:06d}.npy")
            self.assertEqual((spectra.shape, spectra.dtype), ((64, 32, 8), np.complex64))
            power = np.fft.fftshift(np.mean(np.abs(spectra) ** 2, axis=2), axes=1)
            np.testing.assert_allclose(power, record.range_doppler, rtol=1e-4)
            points = np.load(self.out / "radar_PCL" / f"pcl_{number:06d}.npy")
            found = detections(record)
            np.testing.assert_allclose(points[5:8].T * [1, -1, 1], [d.place for d in found])
            np.testing.assert_allclose(
                points[6], points[0] * np.sin(points[1]) * np.cos(points[2]), atol=1e-4
            )
            cloud = np.load(self.out / "laser_PCL" / f"pcl_{number:06d}.npy")
            self.assertEqual(cloud.shape, (len(self.ds.sequences[0]["car/lidar"].at(record.tick).points), 8))
            # The strongest detection of the van bears its power, and its speed is near that of the centre.
            van_ids = set(
                range(
                    int(camera.box_instance[van]),
                    int(camera.box_instance[van] + camera.box_instance_count[van]),
                )
            )
            mine = [d for d in found if d.instance in van_ids]
            self.assertAlmostEqual(values["radar_P_db"], max(d.power_dbm for d in mine), 4)
            best = max(mine, key=lambda d: d.power_dbm)
            self.assertLess(abs(best.velocity_m_s - values["radar_D_mps"]), 2.5)

    def test_a_sample_without_labels(self):
        write_radial(self.ds, self.out, camera="car/front", classes=["person"], pictures=False)
        rows = (self.out / "labels.csv").read_text().splitlines()
        self.assertEqual(rows[1], "0," + ",".join(["-1"] * 13) + ",sequence_0000,0,0")

    def test_errors(self):
        with self.assertRaisesRegex(greatx.DatasetError, "car/right: expected boxes"):
            write_radial(self.ds, self.out, camera="car/right", pictures=False)
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()

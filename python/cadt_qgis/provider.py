# SPDX-License-Identifier: Apache-2.0
"""Processing algorithms that run the program cadt: the package cadt need not be in QGIS's own Python."""

import os
import shutil
import subprocess
import threading

from processing.core.ProcessingConfig import ProcessingConfig, Setting
from qgis.core import (
    QgsApplication,
    QgsProcessingAlgorithm,
    QgsProcessingException,
    QgsProcessingParameterEnum,
    QgsProcessingParameterFile,
    QgsProcessingParameterFileDestination,
    QgsProcessingParameterNumber,
    QgsProcessingParameterRasterDestination,
    QgsProcessingParameterString,
    QgsProcessingParameterVectorDestination,
    QgsProcessingProvider,
)

PROGRAM = "CADT_PROGRAM"
METHODS = ("linear", "nearest", "natural")
LINES = "Lines and polygons (*.gpkg *.geojson *.fgb *.shp)"
POINTS = "Points (*.las *.laz *.LAS *.LAZ *.gpkg *.geojson *.fgb *.parquet *.xyz *.csv *.txt)"


def program():
    """The program of the settings, or the one on PATH."""
    found = shutil.which(ProcessingConfig.getSetting(PROGRAM) or "cadt")
    if found is None:
        raise QgsProcessingException(
            'The program cadt is not there. Install it with: pip install "cadt[terrain]"; if it is not on PATH, name it '
            "in Settings, Options, Processing, Providers, cadt."
        )
    return found


class CadtAlgorithm(QgsProcessingAlgorithm):
    """A command of cadt: `command`, `title`, and what it has beside the options of all of them."""

    command = title = text = ""

    def name(self):
        return self.command

    def displayName(self):
        return self.title

    def shortHelpString(self):
        return self.text

    def createInstance(self):
        return type(self)()

    def initAlgorithm(self, config=None):
        self.addParameter(QgsProcessingParameterFile("INPUT", "Points", fileFilter=POINTS))
        self.addParameter(QgsProcessingParameterString("CLASS", "Classes (2: ground), all if empty", optional=True))
        self.number("MAX_EDGE", "Longest edge of a triangle", optional=True)
        self.addParameter(QgsProcessingParameterString("CRS", "Reference system, if the file has none", optional=True))
        self.addParameter(QgsProcessingParameterFile("BREAKLINES", "Breaklines", fileFilter=LINES, optional=True))
        self.own_parameters()

    def number(self, name, text, optional=False, default=None):
        kind = QgsProcessingParameterNumber.Double
        self.addParameter(QgsProcessingParameterNumber(name, text, kind, default, optional, 0))

    def processAlgorithm(self, parameters, context, feedback):
        output = self.output(parameters, context)
        words = [program(), self.command, self.parameterAsFile(parameters, "INPUT", context), "-o", output]
        for name, option in (("CLASS", "--class"), ("CRS", "--crs")):
            if value := self.parameterAsString(parameters, name, context).strip():
                words += [option, value]
        if lines := self.parameterAsFile(parameters, "BREAKLINES", context):
            words += ["--breaklines", lines]
        if parameters.get("MAX_EDGE") is not None:
            words += ["--max-edge", repr(self.parameterAsDouble(parameters, "MAX_EDGE", context))]
        words += self.own_words(parameters, context)
        feedback.pushCommandInfo(subprocess.list2cmdline(words))
        # QGIS's Python settings are not those of the program's.
        environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONHOME", "PYTHONPATH")}
        process = subprocess.Popen(words, stderr=subprocess.PIPE, encoding="utf-8", errors="replace", env=environment)
        ended = threading.Event()

        def stop_if_canceled():
            while not ended.wait(0.2):
                if feedback.isCanceled():
                    process.terminate()  # once: a second signal would end the program before it has cleaned up
                    return

        threading.Thread(target=stop_if_canceled, daemon=True).start()
        said = process.communicate()[1]
        ended.set()
        if process.returncode != 0 and not feedback.isCanceled():
            raise QgsProcessingException(said.strip() or f"cadt ended with code {process.returncode}")
        feedback.pushConsoleInfo(said)
        return {"OUTPUT": output}

    def output(self, parameters, context):
        return self.parameterAsOutputLayer(parameters, "OUTPUT", context)


class Raster(CadtAlgorithm):
    command, title = "raster", "TIN raster"
    text = "Heights at the centres of a raster's cells, from the Delaunay triangulation of all points, as a GeoTIFF."

    def own_parameters(self):
        self.number("RES", "Size of a cell", default=1.0)
        self.addParameter(QgsProcessingParameterEnum("METHOD", "Between the points", METHODS, defaultValue=0))
        self.addParameter(QgsProcessingParameterRasterDestination("OUTPUT", "Raster"))

    def own_words(self, parameters, context):
        method = METHODS[self.parameterAsEnum(parameters, "METHOD", context)]
        return ["--res", repr(self.parameterAsDouble(parameters, "RES", context)), "--method", method]


class Contour(CadtAlgorithm):
    command, title = "contour", "TIN contour lines"
    text = "Lines of equal height on the triangles, with the attribute elevation."

    def own_parameters(self):
        self.number("INTERVAL", "Height between two lines", default=5.0)
        self.addParameter(QgsProcessingParameterVectorDestination("OUTPUT", "Contour lines"))

    def own_words(self, parameters, context):
        return ["--interval", repr(self.parameterAsDouble(parameters, "INTERVAL", context))]


class Tin(CadtAlgorithm):
    command, title = "tin", "TIN mesh"
    text = "The triangles: as a mesh (.ply, .glb) or as polygons (.gpkg)."

    def own_parameters(self):
        kinds = "Mesh (*.ply);;glTF (*.glb);;Polygons (*.gpkg)"
        self.addParameter(QgsProcessingParameterFileDestination("OUTPUT", "Triangles", kinds))

    def own_words(self, parameters, context):
        return []

    def output(self, parameters, context):
        return self.parameterAsFileOutput(parameters, "OUTPUT", context)


class CadtProvider(QgsProcessingProvider):
    def id(self):
        return "cadt"

    def name(self):
        return "cadt"

    def load(self):
        ProcessingConfig.addSetting(
            Setting("cadt", PROGRAM, "Program cadt (empty: the one on PATH)", "", valuetype=Setting.FILE)
        )
        ProcessingConfig.readSettings()
        self.refreshAlgorithms()
        return True

    def loadAlgorithms(self):
        for algorithm in (Raster(), Contour(), Tin()):
            self.addAlgorithm(algorithm)


class CadtPlugin:
    provider = None

    def initProcessing(self):
        self.provider = CadtProvider()
        QgsApplication.processingRegistry().addProvider(self.provider)

    def initGui(self):
        self.initProcessing()

    def unload(self):
        QgsApplication.processingRegistry().removeProvider(self.provider)

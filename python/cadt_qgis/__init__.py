# SPDX-License-Identifier: Apache-2.0
"""QGIS finds the plugin here."""


def classFactory(iface):
    from .provider import CadtPlugin

    return CadtPlugin()

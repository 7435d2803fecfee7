"""Whole behaviors as pictures: as SVG by the program of the page, from that as PNG and PDF.

For the command line and the page's server. What draws is installed with the extra `picture`, and imported by need.
"""

from engine.editing.pictures.pdf import pdf_of
from engine.editing.pictures.picture import PROGRAM, PictureRequest, draw_svg, png_of

__all__ = ["PROGRAM", "PictureRequest", "draw_svg", "pdf_of", "png_of"]

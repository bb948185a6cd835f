"""``report.html``: one page with a run in it, that opens in any browser without a network."""

from carom.report.writing import GENERATOR, write_page, write_report

__all__ = ["GENERATOR", "write_page", "write_report"]

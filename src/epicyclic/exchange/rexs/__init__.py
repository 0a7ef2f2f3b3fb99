"""REXS, the Reusable Engineering EXchange Standard (rexs.info): read into cases, results back."""

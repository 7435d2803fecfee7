/** Going to a problem: its node on the canvas, its line in the text. */
import type { FindingView } from '../../api/types'
import { problemsOf } from '../../document/editing/findings'
import { allNodes } from '../../document/editing/model'
import { nearestPath } from './marks'
import { reveal } from './session'
import { draftOf, editor, rootOf, setEditor, showEditorNotice } from './store'

export function goTo(finding: FindingView): void {
  const root = rootOf(editor())
  const path = root && nearestPath(new Set(allNodes(root).map((node) => node.path)), finding.path)
  if (path && path !== 'root') reveal(path)
  setEditor({ place: { line: finding.line, column: finding.column }, tab: 'problems' })
}

/** The next one in the order of the text, again from the first after the last. */
export function goToProblem(): void {
  const findings = problemsOf(draftOf(editor()))
  const problemAt = (editor().problemAt + 1) % Math.max(1, findings.length)
  const next = findings[problemAt]
  if (!next) {
    showEditorNotice('No problems')
    return
  }
  setEditor({ problemAt })
  goTo(next)
}

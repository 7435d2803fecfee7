/** What touches in the draft with all arms at home: asked for when nothing was changed for a moment. It hinders nothing. */
import { useEffect } from 'react'
import { cellDocuments } from '../../api/cellDocuments'
import { cellEditor, draftOf, setCellEditor, useCellEditor } from './store'

const PAUSE_MS = 600
const PAGE = crypto.randomUUID()

export function useRestFindings(): void {
  const id = useCellEditor((s) => (s.phase === 'ready' ? s.id : ''))
  const text = useCellEditor((s) => draftOf(s).text)
  // While the text has errors nobody knows what stands where.
  const isKnown = useCellEditor((s) => !draftOf(s).isStale && draftOf(s).kind === 'cell' && draftOf(s).findings.length === 0)
  useEffect(() => {
    if (!id || !isKnown) return
    const timer = setTimeout(() => void look(id, text), PAUSE_MS)
    return () => clearTimeout(timer)
  }, [id, text, isKnown])
}

async function look(id: string, text: string): Promise<void> {
  try {
    const { findings, dropped } = await cellDocuments.rest(id, text, PAGE)
    if (!dropped && cellEditor().id === id && draftOf(cellEditor()).text === text) setCellEditor({ rest: findings })
  } catch {
    // A warning that is not known is none: what is edited does not depend on it.
    if (cellEditor().id === id) setCellEditor({ rest: [] })
  }
}

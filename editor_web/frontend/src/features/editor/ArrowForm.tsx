/** The form of a chosen arrow: from where, with which outcome, to where. */
import { IconArrowRight, IconPlus, IconTrash } from '@tabler/icons-react'
import { edgeOf, NO_EDGE, type EdgeId } from '../../document/edgeId'
import { nodeOf } from '../../document/editing/model'
import { choose, remove } from './actions'
import { openPortPalette, openInsertPalette } from './paletteRequests'
import { rootOf, useEditor } from './store'

export function ArrowForm({ arrow }: { arrow: EdgeId }) {
  const { machine, source, outcome } = edgeOf(arrow) ?? NO_EDGE
  const target = useEditor((s) => nodeOf(rootOf(s), machine)?.transitions.find((t) => t.source === source && t.outcome === outcome)?.target)
  return (
    <div className="node-form">
      <header className="form-head">
        <IconArrowRight size={18} aria-hidden />
        <div className="form-head-text">
          <strong>{outcome}</strong>
          <span className="quiet">
            <button type="button" className="link" onClick={() => choose([`${machine}/${source}`])}>
              {source}
            </button>{' '}
            leads to {target ?? 'nothing'}
          </span>
        </div>
      </header>
      <div className="form-body command-row">
        <button type="button" className="command" onClick={() => openPortPalette(`${machine}/${source}`, outcome)}>
          <IconArrowRight size={15} aria-hidden /> Lead elsewhere
        </button>
        <button type="button" className="command" onClick={() => openInsertPalette(arrow)}>
          <IconPlus size={15} aria-hidden /> Insert a state
        </button>
        <button type="button" className="command" onClick={() => void remove()}>
          <IconTrash size={15} aria-hidden /> Disconnect
        </button>
      </div>
    </div>
  )
}

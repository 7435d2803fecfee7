/** In the form of a node: from where what it reads comes, and who reads what it writes. */
import { flowOfNode } from '../../document/editing/dataFlow'
import type { EditNode } from '../../document/editing/model'
import { Definedness, PathWords } from './DataFlowPanel'
import { goToUse, inputLabel, showKey, useDataFlow, useFreshDataFlow } from './dataFlow'
import { Section } from './Section'

export function FlowSection({ node }: { node: EditNode }) {
  return (
    <Section title="Reads and writes" isClosed note="data flow of this node">
      <NodeFlows path={node.path} />
    </Section>
  )
}

/** Fetched only while the section is open. */
function NodeFlows({ path }: { path: string }) {
  const { flows, problem, of } = useDataFlow()
  useFreshDataFlow(true)
  const { reads, writes } = flowOfNode(flows, path)
  if (problem) return <p className="form-doc">{problem}</p>
  if (of === undefined) return <p className="form-doc">Looking at the behavior …</p>
  if (reads.length + writes.length === 0)
    return <p className="form-doc">It reads and writes no userdata and no parameter of the behavior.</p>
  return (
    <ul className="plain-list node-flows">
      {reads.map(({ key, reader }, index) => (
        <li key={`read ${index}`}>
          <span>
            reads <KeyButton of={key} />
          </span>
          <Definedness reader={reader} />
        </li>
      ))}
      {writes.map(({ key, readers }, index) => (
        <li key={`write ${index}`}>
          <span>
            writes <KeyButton of={key} />
          </span>
          {readers.length === 0 && <span className="quiet">nobody reads it from here</span>}
          {readers.map((reader) => (
            <button key={reader} type="button" className="link" onClick={() => goToUse(reader, inputLabel(key))}>
              read by <PathWords path={reader} />
            </button>
          ))}
        </li>
      ))}
    </ul>
  )
}

function KeyButton({ of }: { of: string }) {
  return (
    <button type="button" className="link mono" title="Show it on the canvas" onClick={() => showKey(of)}>
      {of}
    </button>
  )
}

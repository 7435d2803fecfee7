/** The userdata keys beside the canvas: of what kind they are, who writes and reads each, and on which way one is not defined. */
import { CloseButton } from '@mantine/core'
import { IconAlertTriangleFilled, IconCircleXFilled, IconPencil, IconEye } from '@tabler/icons-react'
import type { KeyFlow, KeyReader, KeyWriter } from '../../api/types'
import { kindOfKey, soundnessOf } from '../../document/editing/dataFlow'
import { nameOfPath, pathsTo } from '../../document/path'
import { goToUse, inputLabel, outputLabel, showKey, toggleDataFlow, useDataFlow, useFreshDataFlow } from './dataFlow'
import { draftOf, rootOf, useEditor } from './store'

export function DataFlowPanel() {
  const { flows, problem, key, of } = useDataFlow()
  useFreshDataFlow(true)
  return (
    <section className="flow-panel" aria-label="Data flow">
      <header>
        <h2>Data flow</h2>
        <CloseButton size="sm" aria-label="Close the data flow" onClick={toggleDataFlow} />
      </header>
      {problem && (
        <p className="flow-problem" role="status">
          {problem}
        </p>
      )}
      {!problem && of === undefined && <p className="quiet">Looking at the behavior …</p>}
      {!problem && of !== undefined && flows.length === 0 && (
        <p className="quiet">
          No userdata yet. Give a state an output, or declare a key in the tab Behavior; what writes and reads it is shown here.
        </p>
      )}
      <div className="flow-keys">
        {flows.map((flow) => (
          <KeyItem key={flow.key} flow={flow} isChosen={key === flow.key} />
        ))}
      </div>
    </section>
  )
}

function KeyItem({ flow, isChosen }: { flow: KeyFlow; isChosen: boolean }) {
  const kind = useEditor((s) => kindOfKey(flow, rootOf(s), draftOf(s).document, s.catalogue))
  const soundness = soundnessOf(flow)
  return (
    <div className={`flow-key${isChosen ? ' is-chosen' : ''}`}>
      <button type="button" aria-expanded={isChosen} onClick={() => showKey(flow.key)}>
        <span className="mono flow-name">{flow.key}</span>
        {kind && <span className="quiet">{kind}</span>}
        <span className="spacer" />
        {soundness === 'never' && <IconCircleXFilled size={14} className="is-never" aria-label="not defined somewhere" />}
        {soundness === 'maybe' && <IconAlertTriangleFilled size={14} className="is-maybe" aria-label="may be undefined somewhere" />}
        <span className="quiet flow-counts">
          <IconPencil size={12} aria-label="written by" /> {flow.writers.length}
          <IconEye size={13} aria-label="read by" /> {flow.readers.length}
        </span>
      </button>
      {isChosen && <Uses flow={flow} />}
    </div>
  )
}

function Uses({ flow }: { flow: KeyFlow }) {
  return (
    <div className="flow-uses">
      <h3>Written by</h3>
      {flow.writers.length === 0 && <p className="is-never">nobody</p>}
      <ul className="plain-list">
        {flow.writers.map((writer, index) => (
          <li key={index}>
            <button type="button" className="flow-use" onClick={() => goToUse(writer.path, outputLabel(writer.name))}>
              <PathWords path={writer.path} />
              <span className="quiet">{writerWords(writer, flow.key)}</span>
            </button>
          </li>
        ))}
      </ul>
      <h3>Read by</h3>
      {flow.readers.length === 0 && <p className="quiet">nobody</p>}
      <ul className="plain-list">
        {flow.readers.map((reader, index) => (
          <li key={index}>
            <button type="button" className="flow-use" onClick={() => goToUse(reader.path, inputLabel(reader.name))}>
              <PathWords path={reader.path} />
              <span className="quiet">{readerWords(reader, flow.key)}</span>
              <Definedness reader={reader} />
            </button>
          </li>
        ))}
      </ul>
    </div>
  )
}

/** The name of a node, and what it is in; of the behavior where the path is empty. */
export function PathWords({ path }: { path: string }) {
  if (path === '') return <strong>the behavior</strong>
  const around = pathsTo(path).slice(1, -1).map(nameOfPath).join(' / ')
  return (
    <span>
      <strong>{nameOfPath(path)}</strong>
      {around && <span className="quiet"> in {around}</span>}
    </span>
  )
}

const ORIGINS: Readonly<Record<string, string>> = {
  parameter: 'parameter of each run',
  userdata: 'initial value',
  item: 'item of each round',
  index: 'number of the round',
  collect: 'collected from its rounds',
}

function writerWords(writer: KeyWriter, key: string): string {
  return ORIGINS[writer.origin] ?? (writer.name === key ? 'output' : `output ${writer.name}`)
}

function readerWords(reader: KeyReader, key: string): string {
  if (reader.by === 'expression') return 'in an expression'
  if (reader.by === 'collect') return 'collects it'
  if (reader.by === 'shared') return 'shares it among its branches'
  return reader.name === key ? 'input' : `input ${reader.name}`
}

/** Where it comes from, or on which way it does not. */
export function Definedness({ reader }: { reader: KeyReader }) {
  switch (reader.defined) {
    case 'always':
      return <span className="quiet">from {sourceWords(reader)}</span>
    case 'maybe':
      return (
        <span className="is-maybe">
          undefined on the path {reader.witness || 'that does not pass a writer'}; else from {sourceWords(reader)}
        </span>
      )
    case 'never':
      return <span className={reader.required ? 'is-never' : 'quiet'}>never defined here</span>
    default:
      return <span className="quiet">nothing leads here</span>
  }
}

function sourceWords(reader: KeyReader): string {
  return reader.sources.map((path) => (path === '' ? 'the behavior' : nameOfPath(path))).join(', ')
}

/** The userdata keys beside the canvas: of what kind they are, who writes and reads each, and on which way one is not defined. */
import { Box, CloseButton, Flex, Text, Title, UnstyledButton } from '@mantine/core'
import { IconAlertTriangleFilled, IconCircleXFilled, IconPencil, IconEye } from '@tabler/icons-react'
import type { ReactNode } from 'react'
import type { KeyFlow, KeyReader, KeyWriter } from '../../api/types'
import { findUsages } from '../../api/usages'
import { watchValueOf } from '../../api/watches'
import { TextButton } from '../../components/TextButton'
import { kindOfKey, soundnessOf } from '../../document/editing/dataFlow'
import { nameOfPath, pathsTo } from '../../document/path'
import { goToUse, inputLabel, outputLabel, showKey, toggleDataFlow, useDataFlow, useFreshDataFlow } from './dataFlow'
import { FormWords } from './FormParts'
import classes from './frame.module.css'
import { PlainList } from './PlainList'
import rows from './row.module.css'
import { draftOf, editor, rootOf, useEditor } from './store'

export function DataFlowPanel() {
  const { flows, problem, key, of } = useDataFlow()
  useFreshDataFlow(true)
  return (
    <section className={classes['side']} aria-label="Data flow">
      <Flex
        component="header"
        align="center"
        justify="space-between"
        pl="sm"
        pr="xs"
        bg="var(--surface)"
        className={classes['bar']}
        mih={38}
      >
        <Title order={2} fz="sm" fw={620}>
          Data flow
        </Title>
        <CloseButton size="sm" aria-label="Close the data flow" onClick={toggleDataFlow} />
      </Flex>
      {problem && (
        <Text size="xs" px="sm" py="xs" bg="var(--failed-soft)" role="status">
          {problem}
        </Text>
      )}
      {!problem && of === undefined && (
        <Box px="sm" py="xs">
          <FormWords>Looking at the behavior …</FormWords>
        </Box>
      )}
      {!problem && of !== undefined && flows.length === 0 && (
        <Box px="sm" py="xs">
          <FormWords>
            No userdata yet. Give a state an output, or declare a key in the tab Behavior; what writes and reads it is shown here.
          </FormWords>
        </Box>
      )}
      <Box p={4} style={{ overflowY: 'auto' }}>
        {flows.map((flow) => (
          <KeyItem key={flow.key} flow={flow} isChosen={key === flow.key} />
        ))}
      </Box>
    </section>
  )
}

function KeyItem({ flow, isChosen }: { flow: KeyFlow; isChosen: boolean }) {
  const kind = useEditor((s) => kindOfKey(flow, rootOf(s), draftOf(s).document, s.catalogue))
  const soundness = soundnessOf(flow)
  return (
    <div>
      <UnstyledButton className={`${rows['row']} pick-row`} aria-expanded={isChosen} onClick={() => showKey(flow.key)}>
        <Text span size="xs" ff="monospace" fw={620} miw="4rem">
          {flow.key}
        </Text>
        <Text span size="xs" c="dimmed" className={rows['line']}>
          {kind}
        </Text>
        {soundness === 'never' && <IconCircleXFilled size={14} color="var(--failed)" aria-label="not defined somewhere" />}
        {soundness === 'maybe' && <IconAlertTriangleFilled size={14} color="var(--stopped)" aria-label="may be undefined somewhere" />}
        <Flex component="span" align="center" gap={4} fz="xs" c="dimmed" flex="none">
          <IconPencil size={12} aria-label="written by" /> {flow.writers.length}
          <IconEye size={13} aria-label="read by" /> {flow.readers.length}
        </Flex>
      </UnstyledButton>
      {isChosen && <Uses flow={flow} />}
    </div>
  )
}

function UsesTitle({ children }: { children: ReactNode }) {
  return (
    <Title order={3} fz="xs" fw={560} c="dimmed" mt={4}>
      {children}
    </Title>
  )
}

function Uses({ flow }: { flow: KeyFlow }) {
  return (
    <Box px={8} pb={8}>
      <UsesTitle>Written by</UsesTitle>
      {flow.writers.length === 0 && (
        <Text size="xs" c="var(--failed)">
          nobody
        </Text>
      )}
      <PlainList>
        {flow.writers.map((writer, index) => (
          <li key={index}>
            <UnstyledButton
              className={`${rows['row']} pick-row`}
              fz="xs"
              px={6}
              py={4}
              display="block"
              onClick={() => goToUse(writer.path, outputLabel(writer.name))}
            >
              <PathWords path={writer.path} />
              <Text inherit c="dimmed">
                {writerWords(writer, flow.key)}
              </Text>
            </UnstyledButton>
          </li>
        ))}
      </PlainList>
      <UsesTitle>Read by</UsesTitle>
      {flow.readers.length === 0 && <FormWords>nobody</FormWords>}
      <PlainList>
        {flow.readers.map((reader, index) => (
          <li key={index}>
            <UnstyledButton
              className={`${rows['row']} pick-row`}
              fz="xs"
              px={6}
              py={4}
              display="block"
              onClick={() => goToUse(reader.path, inputLabel(reader.name))}
            >
              <PathWords path={reader.path} />
              <Text inherit c="dimmed">
                {readerWords(reader, flow.key)}
              </Text>
              <Definedness reader={reader} />
            </UnstyledButton>
          </li>
        ))}
      </PlainList>
      <Text size="xs" mt={4}>
        <TextButton onPress={() => findUsages({ kind: 'key', name: flow.key })}>Find it in all documents</TextButton>,{' '}
        <TextButton onPress={() => watchValueOf(editor().id, { expression: flow.key })}>watch it in runs</TextButton>
      </Text>
    </Box>
  )
}

/** The name of a node, and what it is in; of the behavior where the path is empty. */
export function PathWords({ path }: { path: string }) {
  if (path === '') return <strong>the behavior</strong>
  const around = pathsTo(path).slice(1, -1).map(nameOfPath).join(' / ')
  return (
    <span>
      <strong>{nameOfPath(path)}</strong>
      {around && (
        <Text span inherit c="dimmed">
          {' '}
          in {around}
        </Text>
      )}
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
      return <Words c="dimmed">from {sourceWords(reader)}</Words>
    case 'maybe':
      return (
        <Words c="var(--stopped)">
          undefined on the path {reader.witness || 'that does not pass a writer'}; else from {sourceWords(reader)}
        </Words>
      )
    case 'never':
      return <Words c={reader.required ? 'var(--failed)' : 'dimmed'}>never defined here</Words>
    default:
      return <Words c="dimmed">nothing leads here</Words>
  }
}

function Words({ c, children }: { c: string; children: ReactNode }) {
  return (
    <Text span inherit c={c}>
      {children}
    </Text>
  )
}

function sourceWords(reader: KeyReader): string {
  return reader.sources.map((path) => (path === '' ? 'the behavior' : nameOfPath(path))).join(', ')
}

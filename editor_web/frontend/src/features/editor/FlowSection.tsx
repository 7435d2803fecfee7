/** In the form of a node: from where what it reads comes, and who reads what it writes. */
import { Box, Text } from '@mantine/core'
import { flowOfNode } from '../../document/editing/dataFlow'
import type { EditNode } from '../../document/editing/model'
import { Definedness, PathWords } from './DataFlowPanel'
import { goToUse, inputLabel, showKey, useDataFlow, useFreshDataFlow } from './dataFlow'
import { FormWords, LinkButton } from './FormParts'
import { PlainList } from './PlainList'
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
  if (problem) return <FormWords>{problem}</FormWords>
  if (of === undefined) return <FormWords>Looking at the behavior …</FormWords>
  if (reads.length + writes.length === 0) return <FormWords>It reads and writes no userdata and no parameter of the behavior.</FormWords>
  return (
    <Box fz="xs">
      <PlainList gap={6}>
        {reads.map(({ key, reader }, index) => (
          <li key={`read ${index}`}>
            <div>
              reads <KeyButton of={key} />
            </div>
            <Definedness reader={reader} />
          </li>
        ))}
        {writes.map(({ key, readers }, index) => (
          <li key={`write ${index}`}>
            <div>
              writes <KeyButton of={key} />
            </div>
            {readers.length === 0 && (
              <Text span inherit c="dimmed">
                nobody reads it from here
              </Text>
            )}
            {readers.map((reader) => (
              <div key={reader}>
                <LinkButton onPress={() => goToUse(reader, inputLabel(key))}>
                  read by <PathWords path={reader} />
                </LinkButton>
              </div>
            ))}
          </li>
        ))}
      </PlainList>
    </Box>
  )
}

function KeyButton({ of }: { of: string }) {
  return (
    <LinkButton isMono title="Show it on the canvas" onPress={() => showKey(of)}>
      {of}
    </LinkButton>
  )
}

/** The Python file of a state class, to be read only, with the class marked. */
import { Code, Group, Text } from '@mantine/core'
import { useAnswer } from '../../api/queryClient'
import { stateSourceQuery } from '../../api/stateSource'
import { Dialog } from '../../components/Dialog'
import { lazyView } from '../../components/lazyView'
import { CopyPlace, fileAndLine } from './SourceLine'
import { hideSource, useShownSource } from './stateSource'

const SourceText = lazyView(async () => (await import('./SourceText')).SourceText)

export function SourceDialog() {
  const state = useShownSource((s) => s.state)
  if (state === undefined) return null
  return (
    <Dialog isOpen isWide onClose={hideSource} title={`Source of ${state}`}>
      <Source state={state} />
    </Dialog>
  )
}

function Source({ state }: { readonly state: string }) {
  const { value: source, problem } = useAnswer(stateSourceQuery(state))
  if (problem !== undefined) {
    return (
      <Text size="sm" c="var(--failed)" role="alert">
        {problem}
      </Text>
    )
  }
  if (!source) return <Text size="sm">Loading …</Text>
  return (
    <>
      <Group gap="3xs" mb="xs" fz="sm">
        <Code bg="none" p={0}>
          {fileAndLine(source)}
        </Code>
        <CopyPlace source={source} />
        <Text span size="sm" c="dimmed">
          {source.in_project ? 'of this project' : `installed, module ${source.module}`}
        </Text>
      </Group>
      <SourceText source={source} />
    </>
  )
}
